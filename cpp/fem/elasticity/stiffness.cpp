#include "fem/elasticity/stiffness.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "errors.hpp"
#include "interrupt.hpp"

namespace codesign::fem {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Fills the structure of a; returns for each neighbor of the pattern the first row of its block in
// the columns of the position, counted after the diagonal block.
std::vector<int> fill_structure(const NodePattern& pattern, LowerMatrix& a) {
  const int n = pattern.equations();
  const auto width = [&](int k) { return pattern.dof_start[at(k) + 1] - pattern.dof_start[at(k)]; };
  std::vector<int> offset(pattern.neighbor.size());
  a.start.assign(at(n) + 1, 0);
  for (int k = 0; k < pattern.positions(); ++k) {
    int below = 0;
    for (int p = pattern.start[at(k)]; p < pattern.start[at(k) + 1]; ++p) {
      offset[at(p)] = below;
      below += width(pattern.neighbor[at(p)]);
    }
    const int first = pattern.dof_start[at(k)], last = pattern.dof_start[at(k) + 1];
    for (int d = first; d < last; ++d) a.start[at(d) + 1] = a.start[at(d)] + last - d + below;
  }
  a.row.resize(at(a.start.back()));
  a.value.assign(at(a.start.back()), 0.0);
  for (int k = 0; k < pattern.positions(); ++k) {
    for (int d = pattern.dof_start[at(k)]; d < pattern.dof_start[at(k) + 1]; ++d) {
      int* row = &a.row[at(a.start[at(d)])];
      for (int r = d; r < pattern.dof_start[at(k) + 1]; ++r) *row++ = r;
      for (int p = pattern.start[at(k)]; p < pattern.start[at(k) + 1]; ++p) {
        const int i = pattern.neighbor[at(p)];
        for (int r = pattern.dof_start[at(i)]; r < pattern.dof_start[at(i) + 1]; ++r) *row++ = r;
      }
    }
  }
  return offset;
}

// Elements by their first eliminated node: neighbors in this sequence write to the same columns.
std::vector<int> elements_by_column(const TetMesh& mesh, const NodePattern& pattern) {
  const std::size_t count = at(static_cast<int>(mesh.tets.rows()));
  std::vector<int> first(count), start(at(pattern.positions()) + 2, 0), sequence(count);
  for (std::size_t e = 0; e < count; ++e) {
    first[e] = pattern.positions();
    for (int i = 0; i < kTetNodes; ++i) {
      const int k = pattern.position[at(mesh.tets(static_cast<int>(e), i))];
      if (k >= 0) first[e] = std::min(first[e], k);
    }
    ++start[at(first[e]) + 1];
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  for (std::size_t e = 0; e < count; ++e) sequence[at(start[at(first[e])]++)] = static_cast<int>(e);
  return sequence;
}

// A node of an element as the assembly sees it.
struct LocalNode {
  int position;  // -1 if all its components are held
  int local;     // 0 ... 9
  int first;     // first equation
  int width;     // number of equations
  const int* equation;
};

using LocalNodes = std::array<LocalNode, kTetNodes>;

LocalNodes sorted_nodes(const NodePattern& pattern, const int* tet) {
  LocalNodes nodes;
  for (int i = 0; i < kTetNodes; ++i) {
    LocalNode node{pattern.position[at(tet[i])], i, 0, 0, &pattern.equation[3 * at(tet[i])]};
    if (node.position >= 0) {
      node.first = pattern.dof_start[at(node.position)];
      node.width = pattern.dof_start[at(node.position) + 1] - node.first;
    }
    int j = i;
    for (; j > 0 && nodes[at(j - 1)].position > node.position; --j) nodes[at(j)] = nodes[at(j - 1)];
    nodes[at(j)] = node;
  }
  return nodes;
}

// Adds a block to the columns of one node; base: where the block's first row stands in the node's
// first column. Column c of the node is shorter at its top by c entries.
void add_block(const ElementMatrix& k, const LocalNode& row, const LocalNode& column,
               const std::vector<int>& start, int offset, double* value) {
  const double* block = k.data() + 30 * 3 * column.local + 3 * row.local;
  if (row.width == 3 && column.width == 3) {
    for (int b = 0; b < 3; ++b, block += 30) {
      double* v = value + start[at(column.first + b)] + 3 - b + offset;
      v[0] += block[0];
      v[1] += block[1];
      v[2] += block[2];
    }
    return;
  }
  for (int b = 0; b < 3; ++b, block += 30) {
    const int d = column.equation[b];
    if (d < 0) continue;
    double* v = value + start[at(d)] + column.width - (d - column.first) + offset;
    for (int c = 0; c < 3; ++c) {
      if (row.equation[c] >= 0) v[row.equation[c] - row.first] += block[c];
    }
  }
}

void add_diagonal_block(const ElementMatrix& k, const LocalNode& node,
                        const std::vector<int>& start, double* value) {
  for (int b = 0; b < 3; ++b) {
    const int column = node.equation[b];
    if (column < 0) continue;
    for (int c = 0; c < 3; ++c) {
      const int row = node.equation[c];
      if (row < column) continue;
      value[start[at(column)] + row - column] += k(3 * node.local + c, 3 * node.local + b);
    }
  }
}

void scatter(const NodePattern& pattern, const std::vector<int>& offset, const int* tet,
             const ElementMatrix& k, LowerMatrix& a) {
  const LocalNodes nodes = sorted_nodes(pattern, tet);
  for (int j = 0; j < kTetNodes; ++j) {
    const LocalNode& column = nodes[at(j)];
    if (column.position < 0) continue;
    add_diagonal_block(k, column, a.start, a.value.data());
    int p = pattern.start[at(column.position)];
    for (int i = j + 1; i < kTetNodes; ++i) {
      while (pattern.neighbor[at(p)] != nodes[at(i)].position) ++p;
      add_block(k, nodes[at(i)], column, a.start, offset[at(p)], a.value.data());
    }
  }
}

// Sum of the element matrices that element(e, k) writes into k.
template <class Element>
LowerMatrix assemble(const TetMesh& mesh, const NodePattern& pattern, const Element& element) {
  LowerMatrix a;
  const std::vector<int> offset = fill_structure(pattern, a);
  ElementMatrix k;
  for (const int e : elements_by_column(mesh, pattern)) {
    check_interrupt();
    try {
      element(e, k);
    } catch (const MeshError& error) {
      throw MeshError("element " + std::to_string(e) + ": " + error.what());
    }
    scatter(pattern, offset, mesh.tets.row(e).data(), k, a);
  }
  return a;
}

// Element matrix that acts on each of the three components alike.
void spread(const NodeMatrix& m, ElementMatrix& k) {
  k.setZero();
  for (int j = 0; j < kTetNodes; ++j) {
    for (int i = 0; i < kTetNodes; ++i) {
      k.block<3, 3>(3 * i, 3 * j).diagonal().setConstant(m(i, j));
    }
  }
}

template <class Element>
LowerMatrix assemble_spread(const TetMesh& mesh, const NodePattern& pattern, Element element) {
  NodeMatrix m;
  return assemble(mesh, pattern, [&](int e, ElementMatrix& k) {
    element(e, m);
    spread(m, k);
  });
}

}  // namespace

LowerMatrix assemble_stiffness(const TetMesh& mesh, const Material& material,
                               const NodePattern& pattern) {
  const double lambda = lame_lambda(material), mu = shear_modulus(material);
  return assemble(mesh, pattern, [&](int e, ElementMatrix& k) {
    element_stiffness(tet_nodes(mesh, e), lambda, mu, k);
  });
}

LowerMatrix assemble_mass(const TetMesh& mesh, const Material& material,
                          const NodePattern& pattern) {
  return assemble_spread(mesh, pattern, MassElement(mesh, material));
}

LowerMatrix assemble_geometric_stiffness(const TetMesh& mesh, const Material& material,
                                         const Eigen::VectorXd& displacement,
                                         const NodePattern& pattern) {
  return assemble_spread(mesh, pattern, GeometricElement(mesh, material, displacement));
}

LowerMatrix assemble_linear_stiffness(const TetMesh& mesh, const Material& material,
                                      const Constraints& constraints, const NodePattern& pattern,
                                      double shift) {
  const double lambda = lame_lambda(material), mu = shear_modulus(material);
  MassElement mass(mesh, material);
  NodeMatrix m;
  ElementMatrix full, inert;
  Eigen::Matrix<double, 30, 12> interpolation;
  return assemble(mesh, pattern, [&](int e, ElementMatrix& k) {
    element_stiffness(tet_nodes(mesh, e), lambda, mu, full);
    if (shift > 0.0) {
      mass(e, m);
      spread(m, inert);
      full += shift * inert;
    }
    interpolation.setZero();
    for (int i = 0; i < kTetNodes; ++i) {
      for (int a = 0; a < 3; ++a) {
        if (constraints.fixed[3 * at(mesh.tets(e, i)) + at(a)]) continue;
        if (i < 4) {
          interpolation(3 * i + a, 3 * i + a) = 1.0;
        } else {
          for (const int end : kTetEdges[i - 4]) interpolation(3 * i + a, 3 * end + a) = 0.5;
        }
      }
    }
    k.setZero();
    k.topLeftCorner<12, 12>().noalias() = interpolation.transpose() * full * interpolation;
  });
}

InternalForces internal_forces(const TetMesh& mesh, const Material& material,
                               const Eigen::MatrixXd& displacements) {
  const double lambda = lame_lambda(material), mu = shear_modulus(material);
  const Eigen::Index n = displacements.rows(), fields = displacements.cols();
  InternalForces f{Eigen::MatrixXd::Zero(n, fields), Eigen::MatrixXd::Zero(n, fields)};
  TetPoints points;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    check_interrupt();
    const TetNodes x = tet_nodes(mesh, e);
    evaluate_tet(x, stiffness_rule(x), points);
    for (Eigen::Index k = 0; k < fields; ++k) {
      const TetNodes u = tet_displacements(mesh, e, displacements.col(k));
      TetNodes force = TetNodes::Zero();
      for (int q = 0; q < points.count; ++q) {
        const TetGradients& g = points.gradients[at(q)];
        force.noalias() += points.weights[at(q)] * (stress_tensor(lambda, mu, u, g) * g);
      }
      for (int i = 0; i < kTetNodes; ++i) {
        f.sum.block<3, 1>(3 * mesh.tets(e, i), k) += force.col(i);
        f.size.block<3, 1>(3 * mesh.tets(e, i), k) += force.col(i).cwiseAbs();
      }
    }
  }
  return f;
}

}  // namespace codesign::fem
