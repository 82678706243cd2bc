#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fem/smoothing/planar_regions.hpp"

namespace codesign::fem {

// Normals of the smooth surface of which a coarse surface is the tessellation.
struct SmoothNormals {
  std::vector<std::array<Eigen::Vector3d, 3>> at_corner;  // (m) of each triangle, unit
  std::vector<std::array<bool, 3>> singular;              // (m) no normal there: tip of a cone
  std::vector<std::array<bool, 3>> sharp;  // (m) edge from corner k is a line of the surface
  std::vector<bool> curved;                // (m) the triangle is a chord of a curved surface
  PlanarRegions regions;
};

// Triangles that meet at a corner across smooth edges share its normal. First guess: the mean of
// the planar regions' normals, weighted by angle, so that it does not matter how a strip is cut
// into triangles (G. Thürmer, C. Wüthrich, "Computing vertex normals from polygonal facets", J.
// Graphics Tools 3(1), 1998). Then the normals n, m at both ends of every edge c shall fulfill
// (n + m) · c = 0, as on planes, spheres and cylinders for any chord, in the sense of least
// squares, with those of flat regions held and straight lines of cylinders kept straight. Where
// they contradict a triangle it stays as it is. feature_angle [rad]: edges sharper than this are
// lines.
SmoothNormals find_smooth_normals(const SurfaceMesh& surface, double feature_angle);

}  // namespace codesign::fem
