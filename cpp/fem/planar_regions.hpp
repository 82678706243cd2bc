#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/surface_features.hpp"
#include "fem/surface_mesh.hpp"

namespace codesign::fem {

// A border edge of a planar region where the surface goes on smoothly.
struct RegionSide {
  int other;      // region across
  int from, to;   // points
  double turn;    // of the normal from this region to the other, rad; negative where concave
  double width;   // of this region, measured from the edge, m
  double beyond;  // width of the other region, m
};

// Pieces of the surface whose triangles lie in one plane: faces of the solid, or single chords of
// a curved face.
struct PlanarRegions {
  std::vector<int> of_triangle;             // (m) region of each triangle, 0-based
  std::vector<std::vector<int>> triangles;  // of each region
  std::vector<Eigen::Vector3d> normal;      // unit, outward
  std::vector<bool> flat;                   // a face of the solid, which stays as it is
};

// Groups triangles into planes, largest first; `flat` is left empty.
PlanarRegions find_planar_regions(const SurfaceMesh& surface, const Neighbours& neighbours);

// Tells faces of the solid from chords of curved ones. A tangent-continuous surface whose planar
// pieces R and S turn by t(R) and t(S) bends by (t(R) + t(S)) / 2 at their common edge, whether it
// is an arc, or a flat (turn 0) that runs into a fillet; t(S) follows from the edge beyond S. Flat
// is also what is no triangle or convex quadrangle, what would turn by more than `feature_angle`
// [rad], what is far wider than its neighbours, and whatever has only flat neighbours (a chamfer).
void mark_flat_regions(const SurfaceMesh& surface, const Neighbours& neighbours,
                       PlanarRegions& regions, double feature_angle);

}  // namespace codesign::fem
