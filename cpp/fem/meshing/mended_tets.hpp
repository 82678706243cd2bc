#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fem/meshing/linear_tets.hpp"
#include "fem/meshing/prepared_surface.hpp"

namespace codesign::fem {

// All tetrahedra between the points of the mesher, to their convex hull; those inside fill the
// solid.
struct HullTets {
  std::vector<Eigen::Vector3d> points;   // m
  std::vector<int> dimension;            // of their place: 0 corner, 1 line, 2 surface, 3 inside
  std::vector<std::array<int, 4>> tets;  // positive volume
  std::vector<bool> inside;
};

// The mesher takes a tetrahedron as inside if the center of its sphere is, which tears the solid
// where faces meet at a small angle or nearly touch. Here its own center decides where that lies
// clearly off the surface (by `share` of the longest edge); voids and loose pieces that the surface
// does not have go, and so do tetrahedra by which the solid touches itself, those of least volume
// first. Where the boundary still touches itself without being connected, points are there once for
// each part. Whether the result has the topology of the surface is the caller's to see.
LinearTets mend_tets(const HullTets& hull, const PreparedSurface& prepared, double share);

}  // namespace codesign::fem
