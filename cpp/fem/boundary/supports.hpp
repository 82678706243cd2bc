#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fem/boundary/selection.hpp"
#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// Fixes displacement components of the selected nodes.
struct Support {
  Selection where;
  std::array<bool, 3> fixed{true, true, true};
  // Prescribed displacement (m): no row (zero), one row for all nodes, or a row for each node of a
  // selection that holds nodes only, in its order.
  Points displacement{};
  // True for the cut plane of a half model: it is no clamp, the peak stress counts up to it.
  bool symmetry = false;
};

// Which of the 3 n components are prescribed and to what; the first support that names a component
// holds it.
struct Constraints {
  std::vector<char> fixed;       // (3 n)
  std::vector<int> support;      // (3 n) index of the support, -1 if free
  Eigen::VectorXd displacement;  // (3 n) m, zero where free
};

// Nodes that belong to no element are held at zero. Throws ModelError for an empty selection or two
// different prescribed values of one component.
Constraints constrain(const TetMesh& mesh, const std::vector<Support>& supports);

// What free components feel of nodal vectors (3 n, k): zero where held.
Eigen::MatrixXd felt(const Constraints& constraints, Eigen::MatrixXd nodal);

// Boundary triangles selected by supports that are no symmetry planes: the constrained faces, from
// which the peak stress keeps its distance. Sorted.
std::vector<int> clamped_triangles(const TetMesh& mesh, const std::vector<Support>& supports);

// Boundary triangles of symmetry planes. Sorted.
std::vector<int> symmetry_triangles(const TetMesh& mesh, const std::vector<Support>& supports);

}  // namespace codesign::fem
