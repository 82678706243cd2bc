#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/boundary/supports.hpp"
#include "fem/la/supernodes.hpp"
#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// Symmetric sparsity pattern of the stiffness and of its Cholesky factor in terms of nodes, in
// elimination order: position k is eliminated k-th, the free components of a node together.
struct NodePattern {
  std::vector<int> order;      // (m) mesh node at a position; only nodes with a free component
  std::vector<int> position;   // (n) position of a mesh node, -1 if all its components are held
  std::vector<int> dof_start;  // (m + 1) first equation of a position
  std::vector<int> equation;   // (3 n) equation of a node's component, -1 if held
  std::vector<int> start;      // (m + 1) into neighbor
  std::vector<int> neighbor;   // positions > k that share an element with k, ascending
  Supernodes supernodes;

  int positions() const { return static_cast<int>(order.size()); }
  int equations() const { return dof_start.back(); }
};

// How the fill of the factor is kept small.
enum class VertexOrdering { automatic, minimum_degree, nested_dissection };

// Nodes that a dense matrix couples beside the elements: each of a group with each other one.
struct CoupledNodes {
  std::vector<std::vector<int>> groups;  // no node is in two
  bool last = false;                     // come after all other nodes, in the order given
};

// Fill-reducing order: only corner vertices are ordered (minimum degree, or nested dissection for
// large meshes); each mid-edge node goes just before the earlier eliminated of its two ends.
// Ordering the corners alone costs a tenth to a thirtieth of ordering all nodes and keeps the fill.
// The pattern has no supernodes.
NodePattern fill_reducing_order(const TetMesh& mesh, const Constraints& constraints,
                                VertexOrdering method = VertexOrdering::automatic,
                                const CoupledNodes& coupled = {});

// The fill-reducing order made one of the amalgamated supernodes' tree.
NodePattern order_nodes(const TetMesh& mesh, const Constraints& constraints,
                        VertexOrdering method = VertexOrdering::automatic,
                        const CoupledNodes& coupled = {});

// Values of the equations, a column each, as nodal components (3 n, k); zero where held.
Eigen::MatrixXd nodal_columns(const NodePattern& pattern, const Eigen::MatrixXd& free);

}  // namespace codesign::fem
