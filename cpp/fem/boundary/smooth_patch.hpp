#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/boundary/primitive.hpp"
#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// A piece of one smooth face of a triangulated surface.
struct SmoothPatch {
  SurfaceType type = SurfaceType::free;
  std::vector<int> triangles;  // sorted
};

// Index of the triangle nearest to a point (m). Throws std::invalid_argument if there is none.
int nearest_triangle(const SurfaceMesh& surface, const Eigen::Vector3d& point);

// The face that a triangle belongs to: what is connected to it within the same named face, bends by
// no more than max_bend (rad) from triangle to triangle, and lies on the same plane, cylinder, cone
// or sphere. A curved shape is taken if it explains 2.7 times the area that the plane of the
// start does. On other (free) surfaces the patch ends at the next plane.
SmoothPatch smooth_patch(const SurfaceMesh& surface, int start, double max_bend);

}  // namespace codesign::fem
