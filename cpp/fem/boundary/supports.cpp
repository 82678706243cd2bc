#include "fem/boundary/supports.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model_error.hpp"

namespace codesign::fem {

namespace {

// Nodes of the support in the order of its displacement rows.
std::vector<int> support_nodes(const TetMesh& mesh, const Support& support) {
  std::vector<int> nodes = selected_nodes(mesh, support.where);
  const Eigen::Index rows = support.displacement.rows();
  if (rows <= 1) return nodes;
  if (!support.where.faces.empty() || !support.where.triangles.empty() ||
      rows != static_cast<Eigen::Index>(support.where.nodes.size())) {
    throw std::invalid_argument(
        "a support's displacement has no row, one row, or a row for each node of a selection of "
        "nodes");
  }
  return support.where.nodes;
}

// Boundary triangles of the supports that are symmetry planes, or of those that are not.
std::vector<int> held_triangles(const TetMesh& mesh, const std::vector<Support>& supports,
                                bool symmetry) {
  std::vector<int> result;
  for (const Support& support : supports) {
    if (support.symmetry != symmetry) continue;
    if (support.where.faces.empty() && support.where.triangles.empty()) continue;
    const Selection faces_only{support.where.faces, support.where.triangles, {}};
    const std::vector<int> triangles = selected_triangles(mesh, faces_only);
    result.insert(result.end(), triangles.begin(), triangles.end());
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace

Constraints constrain(const TetMesh& mesh, const std::vector<Support>& supports) {
  const std::size_t n = static_cast<std::size_t>(3 * mesh.nodes.rows());
  Constraints c;
  c.fixed.assign(n, 1);
  c.support.assign(n, -1);
  c.displacement = Eigen::VectorXd::Zero(3 * mesh.nodes.rows());
  for (Eigen::Index i = 0; i < mesh.tets.size(); ++i) {
    for (int a = 0; a < 3; ++a) c.fixed[static_cast<std::size_t>(3 * mesh.tets.data()[i] + a)] = 0;
  }
  for (std::size_t s = 0; s < supports.size(); ++s) {
    const Support& support = supports[s];
    if (!support.displacement.allFinite()) {
      throw std::invalid_argument("a support's displacement must be finite");
    }
    const std::vector<int> nodes = support_nodes(mesh, support);
    const Eigen::Index rows = support.displacement.rows();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      for (int a = 0; a < 3; ++a) {
        if (!support.fixed[static_cast<std::size_t>(a)]) continue;
        const std::size_t dof = static_cast<std::size_t>(3 * nodes[i] + a);
        const Eigen::Index row = rows > 1 ? static_cast<Eigen::Index>(i) : 0;
        const double value = rows == 0 ? 0.0 : support.displacement(row, a);
        double& held = c.displacement[static_cast<Eigen::Index>(dof)];
        if (c.support[dof] >= 0 && std::abs(held - value) > 1e-14 * std::abs(held + value)) {
          throw ModelError("two supports prescribe different displacements of node " +
                           std::to_string(nodes[i]));
        }
        if (c.support[dof] < 0) c.support[dof] = static_cast<int>(s);
        c.fixed[dof] = 1;
        held = value;
      }
    }
  }
  return c;
}

Eigen::MatrixXd felt(const Constraints& constraints, Eigen::MatrixXd nodal) {
  for (std::size_t d = 0; d < constraints.fixed.size(); ++d)
    if (constraints.fixed[d]) nodal.row(static_cast<Eigen::Index>(d)).setZero();
  return nodal;
}

std::vector<int> clamped_triangles(const TetMesh& mesh, const std::vector<Support>& supports) {
  return held_triangles(mesh, supports, false);
}

std::vector<int> symmetry_triangles(const TetMesh& mesh, const std::vector<Support>& supports) {
  return held_triangles(mesh, supports, true);
}

}  // namespace codesign::fem
