#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace codesign::fem {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

// A closed, outward-oriented triangulated surface whose triangles belong to faces.
// Face k has the name face_names[k]; borders between different faces are kept as feature lines by
// the mesher.
struct SurfaceMesh {
  Points points;                        // (n, 3) m
  Triangles triangles;                  // (m, 3) counter-clockwise seen from outside
  std::vector<int> face;                // (m) index into face_names
  std::vector<std::string> face_names;  // unnamed surface has the name ""
};

// Throws std::invalid_argument if array sizes, indices or names do not fit together, MeshError if a
// coordinate is not finite. Says nothing about closedness: see check_surface.
void check_arrays(const SurfaceMesh& surface);

// Corner k (0..2) of triangle t. [m]
Eigen::Vector3d corner(const SurfaceMesh& surface, Eigen::Index t, int k);

// Unit outward normal of triangle t; zero if the triangle has no area.
Eigen::Vector3d triangle_normal(const SurfaceMesh& surface, Eigen::Index t);

// Area of triangle t. [m²]
double triangle_area(const SurfaceMesh& surface, Eigen::Index t);

// Area of each face, in the order of face_names. [m²]
std::vector<double> face_areas(const SurfaceMesh& surface);

// Volume enclosed (divergence theorem); negative if the surface is inside-out. [m³]
double enclosed_volume(const SurfaceMesh& surface);

// Diagonal of the bounding box. [m]
double extent(const Points& points);

}  // namespace codesign::fem
