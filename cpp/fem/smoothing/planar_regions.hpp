#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/surface/surface_features.hpp"
#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// Pieces of the surface whose triangles lie in one plane: faces of the solid, or single chords of
// a curved face.
struct PlanarRegions {
  std::vector<int> of_triangle;             // (m) region of each triangle, 0-based
  std::vector<std::vector<int>> triangles;  // of each region
  std::vector<Eigen::Vector3d> normal;      // unit, outward
  std::vector<bool> flat;                   // a face of the solid, which stays as it is
  // Edges of quadrangles across which these are straight, as a cylinder is towards the fillet or
  // the sharp edge at its end.
  struct Straight {
    int region, from, to;  // the edge, counter-clockwise
    int before, after;     // points beside it on the outline; the ends where it goes straight on
  };
  std::vector<Straight> straight;
};

// Groups triangles into planes, largest first; `flat` is left empty.
PlanarRegions find_planar_regions(const SurfaceMesh& surface, const Neighbors& neighbors);

// Tells faces of the solid from chords of curved ones. A tangent-continuous surface whose planar
// pieces R and S turn by t(R) and t(S) bends by (t(R) + t(S)) / 2 at their common edge; a turn is 0
// where a flat or a straight line of a cylinder runs into a fillet, and negative where the surface
// is concave. t(R) and t(S) follow from the edges opposite to the common one; which of them are 0
// is what explains the bend there. Where nothing does, the edge is a crease and both run straight
// on. Flat is what is curved nowhere, and what is no triangle or convex quadrangle.
void mark_flat_regions(const SurfaceMesh& surface, const Neighbors& neighbors,
                       PlanarRegions& regions, double feature_angle);

}  // namespace codesign::fem
