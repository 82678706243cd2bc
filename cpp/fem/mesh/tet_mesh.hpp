#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

using Tets10 = Eigen::Matrix<int, Eigen::Dynamic, 10, Eigen::RowMajor>;
using Triangles6 = Eigen::Matrix<int, Eigen::Dynamic, 6, Eigen::RowMajor>;

// What was done to a surface and its elements to get a sound mesh; zero for a user's own mesh.
struct MeshReport {
  int collapsed = 0;               // short edges of the surface
  double collapse_distance = 0.0;  // the farthest that a point of the surface moved for that, m
  int crumbs = 0;                  // elements removed that hung on the mesh by a point or an edge
  int peeled = 0;                  // flat boundary elements removed
  std::size_t questions = 0;       // of the refinement about solid and size: its work
  int refinements = 0;             // rounds of smaller elements, to keep the surface's topology
  int small_faults = 0;            // where the boundary touches itself on ledges below 0.05 mm
  std::vector<int> genus = {};     // of each closed piece of the surface, and of the solid
  double surface_distance = -1.0;  // largest between boundary and surface, m; -1: not measured
};

// Quadratic tetrahedra. Corner nodes first (positive volume: det(x1-x0, x2-x0, x3-x0) > 0), then
// the mid-edge nodes on edges 01 12 02 03 13 23 (the order of VTK and Abaqus). Boundary triangles:
// corners counter-clockwise seen from outside, then the mid-edge nodes on 01 12 20.
struct TetMesh {
  Points nodes;                         // (n, 3) m
  Tets10 tets;                          // (m, 10)
  Triangles6 boundary;                  // (b, 6)
  std::vector<int> boundary_face;       // (b) index into face_names
  std::vector<std::string> face_names;  // as in the surface it was made from
  MeshReport report = {};
};

}  // namespace codesign::fem
