#pragma once

#include <vector>

#include "fem/mesh/tet_mesh.hpp"
#include "fem/surface/surface_features.hpp"

namespace codesign::fem {

// An edge of the boundary between two boundary triangles; inside: belongs to the set.
struct BorderEdge {
  int inside;
  int side;  // edge from corner `side` of `inside` to the next one
  int outside;
};

// Neighbors over the corner nodes of the boundary.
Neighbors boundary_neighbors(const TetMesh& mesh);

// Whether the solid is re-entrant at the edge and bends there by more than `bend` (rad).
bool is_sharp_pocket(const TetMesh& mesh, const BorderEdge& edge, double bend);

// Edges between a set of boundary triangles (sorted) and the rest. Those to `ignored` triangles
// (sorted), a cut plane, say, are no border.
std::vector<BorderEdge> border_edges(const Neighbors& neighbors, const std::vector<int>& set,
                                     const std::vector<int>& ignored);

// Size (m) of what the part has around each edge of a clamp's border, the smallest of
//   the wall behind the free surface beside the edge and behind the clamp (inward normals), and any
//   thinner wall that a `share` of the size would reach,
//   the distance along the smooth surface on either side of the edge, over which it turns by one
//   radian: the radius of a hole, of a fillet or of a shaft,
//   4 A / P of the clamped piece of surface (area and perimeter): twice the width of a strip.
std::vector<double> local_features(const TetMesh& mesh, const Neighbors& neighbors,
                                   const std::vector<int>& clamped,
                                   const std::vector<BorderEdge>& border, double share);

}  // namespace codesign::fem
