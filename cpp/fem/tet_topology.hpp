#pragma once

#include <Eigen/Core>

#include "fem/tet_mesh.hpp"

namespace codesign::fem {

using Tets4 = Eigen::Matrix<int, Eigen::Dynamic, 4, Eigen::RowMajor>;

// Quadratic mesh of a user's linear tetrahedra: adds straight mid-edge nodes after the given nodes
// and the boundary (one unnamed face). Elements given inside out are turned over. Throws MeshError
// for indices out of range, flat elements or a face shared by more than two elements.
TetMesh make_tet_mesh(const Points& nodes, const Tets4& tets);

// The same for ten-node tetrahedra, mid-edge nodes on edges 01 12 02 03 13 23.
TetMesh make_tet_mesh(const Points& nodes, const Tets10& tets);

}  // namespace codesign::fem
