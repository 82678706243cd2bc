#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

using Tets4 = Eigen::Matrix<int, Eigen::Dynamic, 4, Eigen::RowMajor>;

// Corner columns of the four sides of a tetrahedron, counter-clockwise seen from outside; side k is
// opposite to corner k.
inline constexpr int kTetSides[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

// neighbors[t][k]: the tetrahedron across side k of tetrahedron t, or -1 on the boundary. Throws
// MeshError if three tetrahedra share a side.
using TetNeighbors = std::vector<std::array<int, 4>>;
TetNeighbors tet_neighbors(const Eigen::Ref<const Tets4, 0, Eigen::OuterStride<>>& tets);

}  // namespace codesign::fem
