#include "fem/elasticity/nodal_matrices.hpp"

#include <algorithm>

#include "fem/elasticity/element_matrices.hpp"
#include "interrupt.hpp"

namespace codesign::fem {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Where a row stands in a column of a matrix that has it.
std::size_t entry(const LowerMatrix& a, int row, int column) {
  const auto first = a.row.begin() + a.start[at(column)];
  const auto last = a.row.begin() + a.start[at(column) + 1];
  return static_cast<std::size_t>(std::lower_bound(first, last, row) - a.row.begin());
}

template <class Element>
LowerMatrix assemble(const TetMesh& mesh, const NodePattern& pattern, Element element) {
  LowerMatrix a;
  const int n = pattern.positions();
  a.start.resize(at(n) + 1);
  for (int k = 0; k <= n; ++k) a.start[at(k)] = pattern.start[at(k)] + k;  // and the diagonal
  a.row.reserve(at(a.start.back()));
  for (int k = 0; k < n; ++k) {
    a.row.push_back(k);
    a.row.insert(a.row.end(), pattern.neighbor.begin() + pattern.start[at(k)],
                 pattern.neighbor.begin() + pattern.start[at(k) + 1]);
  }
  a.value.assign(a.row.size(), 0.0);
  NodeMatrix m;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    check_interrupt();
    element(e, m);
    for (int j = 0; j < kTetNodes; ++j) {
      const int column = pattern.position[at(mesh.tets(e, j))];
      for (int i = 0; i < kTetNodes; ++i) {
        const int row = pattern.position[at(mesh.tets(e, i))];
        if (column >= 0 && row >= column) a.value[entry(a, row, column)] += m(i, j);
      }
    }
  }
  return a;
}

// Calls visit(row, column, value) for the equations that the entries connect.
template <class Visit>
void for_equations(const NodePattern& pattern, const LowerMatrix& nodal, const Visit& visit) {
  for (int k = 0; k < nodal.size(); ++k) {
    const int* column = &pattern.equation[3 * at(pattern.order[at(k)])];
    for (int p = nodal.start[at(k)]; p < nodal.start[at(k) + 1]; ++p) {
      const int* row = &pattern.equation[3 * at(pattern.order[at(nodal.row[at(p)])])];
      for (int c = 0; c < 3; ++c) {
        if (row[c] >= 0 && column[c] >= 0) visit(row[c], column[c], nodal.value[at(p)]);
      }
    }
  }
}

}  // namespace

LowerMatrix assemble_nodal_mass(const TetMesh& mesh, const Material& material,
                                const NodePattern& pattern) {
  return assemble(mesh, pattern, MassElement(mesh, material));
}

LowerMatrix assemble_nodal_geometric_stiffness(const TetMesh& mesh, const Material& material,
                                               const Eigen::VectorXd& displacement,
                                               const NodePattern& pattern) {
  return assemble(mesh, pattern, GeometricElement(mesh, material, displacement));
}

Eigen::VectorXd multiply_nodal(const NodePattern& pattern, const LowerMatrix& nodal,
                               const Eigen::VectorXd& x) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
  for_equations(pattern, nodal, [&](int row, int column, double value) {
    y[row] += value * x[column];
    if (row != column) y[column] += value * x[row];
  });
  return y;
}

void add_nodal(double factor, const LowerMatrix& nodal, const NodePattern& pattern,
               LowerMatrix& matrix) {
  for_equations(pattern, nodal, [&](int row, int column, double value) {
    matrix.value[entry(matrix, row, column)] += factor * value;
  });
}

}  // namespace codesign::fem
