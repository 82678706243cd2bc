#include "fem/stiffness.hpp"

#include <algorithm>

#include "errors.hpp"

namespace codesign::fem {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Position of each block of the pattern inside its dof columns, and the columns themselves.
struct BlockOffsets {
  std::vector<int> row_offset;  // (blocks) first row of the block, counted after the diagonal block
};

BlockOffsets fill_pattern(const NodePattern& pattern, LowerMatrix& a) {
  BlockOffsets offsets;
  offsets.row_offset.resize(pattern.neighbor.size());
  const int n = pattern.equations();
  a.start.reserve(at(n) + 1);
  a.start.push_back(0);
  std::vector<int> below;
  for (int k = 0; k < pattern.positions(); ++k) {
    below.clear();
    for (int p = pattern.start[at(k)]; p < pattern.start[at(k) + 1]; ++p) {
      offsets.row_offset[at(p)] = static_cast<int>(below.size());
      const int i = pattern.neighbor[at(p)];
      for (int d = pattern.dof_start[at(i)]; d < pattern.dof_start[at(i) + 1]; ++d) {
        below.push_back(d);
      }
    }
    const int first = pattern.dof_start[at(k)], last = pattern.dof_start[at(k) + 1];
    for (int column = first; column < last; ++column) {
      for (int d = column; d < last; ++d) a.row.push_back(d);
      a.row.insert(a.row.end(), below.begin(), below.end());
      a.start.push_back(static_cast<int>(a.row.size()));
    }
  }
  a.value.assign(a.row.size(), 0.0);
  return offsets;
}

// Adds the element block (row node, column node) at its place; local components of held equations
// are skipped.
void scatter(const NodePattern& pattern, const BlockOffsets& offsets, const int* tet,
             const ElementMatrix& k, LowerMatrix& a) {
  for (int j = 0; j < kTetNodes; ++j) {
    const int column_position = pattern.position[at(tet[j])];
    if (column_position < 0) continue;
    const int* column_equation = &pattern.equation[3 * at(tet[j])];
    const int first = pattern.dof_start[at(column_position)];
    const int width = pattern.dof_start[at(column_position) + 1] - first;
    const auto begin = pattern.neighbor.begin() + pattern.start[at(column_position)];
    const auto end = pattern.neighbor.begin() + pattern.start[at(column_position) + 1];
    for (int i = 0; i < kTetNodes; ++i) {
      const int row_position = pattern.position[at(tet[i])];
      if (row_position < column_position) continue;
      const bool diagonal = row_position == column_position;
      const int* row_equation = &pattern.equation[3 * at(tet[i])];
      const int row_first = pattern.dof_start[at(row_position)];
      const int offset =
          diagonal ? 0
                   : offsets.row_offset[at(static_cast<int>(
                         std::lower_bound(begin, end, row_position) - pattern.neighbor.begin()))];
      for (int b = 0; b < 3; ++b) {
        const int column = column_equation[b];
        if (column < 0) continue;
        const int local_column = column - first;
        const int base = a.start[at(column)] + (diagonal ? -local_column : width - local_column);
        for (int c = 0; c < 3; ++c) {
          const int row = row_equation[c];
          if (row < 0 || row < column) continue;
          a.value[at(base + offset + row - row_first)] += k(3 * i + c, 3 * j + b);
        }
      }
    }
  }
}

}  // namespace

void element_stiffness(const TetNodes& x, double lambda, double mu, ElementMatrix& k) {
  TetPoints points;
  evaluate_tet(x, stiffness_rule(x), points);
  // Integral of grad_a N_i grad_b N_j, from which isotropic elasticity is a recombination.
  ElementMatrix g = ElementMatrix::Zero();
  for (int q = 0; q < points.count; ++q) {
    const double weight = points.weights[at(q)];
    if (!(weight > 0)) throw MeshError("inverted element: its Jacobian is not positive");
    const Eigen::Map<const Eigen::Matrix<double, 30, 1>> v(points.gradients[at(q)].data());
    g.noalias() += (weight * v) * v.transpose();
  }
  for (int j = 0; j < kTetNodes; ++j) {
    for (int i = 0; i < kTetNodes; ++i) {
      const Eigen::Matrix3d gij = g.block<3, 3>(3 * i, 3 * j);
      k.block<3, 3>(3 * i, 3 * j) = lambda * gij + mu * gij.transpose();
      k.block<3, 3>(3 * i, 3 * j).diagonal().array() += mu * gij.trace();
    }
  }
}

Eigen::VectorXd multiply(const LowerMatrix& a, const Eigen::VectorXd& x) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
  for (int j = 0; j < a.size(); ++j) {
    int p = a.start[at(j)];
    double sum = a.value[at(p)] * x[j];
    for (++p; p < a.start[at(j) + 1]; ++p) {
      const int i = a.row[at(p)];
      y[i] += a.value[at(p)] * x[j];
      sum += a.value[at(p)] * x[i];
    }
    y[j] += sum;
  }
  return y;
}

LowerMatrix assemble_stiffness(const TetMesh& mesh, const Material& material,
                               const NodePattern& pattern) {
  LowerMatrix a;
  const BlockOffsets offsets = fill_pattern(pattern, a);
  const double lambda = lame_lambda(material), mu = shear_modulus(material);
  ElementMatrix k;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    try {
      element_stiffness(tet_nodes(mesh, e), lambda, mu, k);
    } catch (const MeshError& error) {
      throw MeshError("element " + std::to_string(e) + ": " + error.what());
    }
    scatter(pattern, offsets, mesh.tets.row(e).data(), k, a);
  }
  return a;
}

Eigen::VectorXd internal_forces(const TetMesh& mesh, const Material& material,
                                const Eigen::VectorXd& displacement) {
  const double lambda = lame_lambda(material), mu = shear_modulus(material);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(displacement.size());
  TetPoints points;
  TetNodes u;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    const TetNodes x = tet_nodes(mesh, e);
    evaluate_tet(x, stiffness_rule(x), points);
    for (int i = 0; i < kTetNodes; ++i) u.col(i) = displacement.segment<3>(3 * mesh.tets(e, i));
    TetNodes force = TetNodes::Zero();
    for (int q = 0; q < points.count; ++q) {
      const TetGradients& g = points.gradients[at(q)];
      const Eigen::Matrix3d h = u * g.transpose();  // d u_i / d x_j
      Eigen::Matrix3d stress = mu * (h + h.transpose());
      stress.diagonal().array() += lambda * h.trace();
      force.noalias() += points.weights[at(q)] * (stress * g);
    }
    for (int i = 0; i < kTetNodes; ++i) f.segment<3>(3 * mesh.tets(e, i)) += force.col(i);
  }
  return f;
}

}  // namespace codesign::fem
