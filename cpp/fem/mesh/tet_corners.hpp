#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "fem/mesh/tet_neighbors.hpp"
#include "fem/surface/disjoint_sets.hpp"

namespace codesign::fem {

// Corners and edges of tetrahedra, joined where they hang together by sides about the same point or
// edge: item 4 · t + k is corner k, item 6 · t + e edge e (in the order of kTetEdges) of
// tetrahedron t.
struct CornerGroups {
  DisjointSets points, edges;
};

// The same corners of neighbors are joined; of two kinds of tetrahedra, only those of one kind.
// inside: the kind of each, or empty.
CornerGroups group_corners(const Eigen::Ref<const Tets4, 0, Eigen::OuterStride<>>& tets,
                           const TetNeighbors& neighbors, const std::vector<bool>& inside = {});

// The two corners of an edge of a tetrahedron.
std::array<std::size_t, 2> edge_corners(std::size_t edge);

}  // namespace codesign::fem
