#include "fem/mesh/tet10.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace codesign::fem {

TetValues tet10_values(const Eigen::Vector3d& xi) {
  const double l[4] = {1.0 - xi.sum(), xi[0], xi[1], xi[2]};
  TetValues n;
  for (int i = 0; i < 4; ++i) n[i] = l[i] * (2.0 * l[i] - 1.0);
  for (int k = 0; k < 6; ++k) n[4 + k] = 4.0 * l[kTetEdges[k][0]] * l[kTetEdges[k][1]];
  return n;
}

TetGradients tet10_reference_gradients(const Eigen::Vector3d& xi) {
  const double l[4] = {1.0 - xi.sum(), xi[0], xi[1], xi[2]};
  Eigen::Matrix<double, 3, 4> dl;
  dl << -1, 1, 0, 0, -1, 0, 1, 0, -1, 0, 0, 1;
  TetGradients g;
  for (int i = 0; i < 4; ++i) g.col(i) = (4.0 * l[i] - 1.0) * dl.col(i);
  for (int k = 0; k < 6; ++k) {
    const int a = kTetEdges[k][0], b = kTetEdges[k][1];
    g.col(4 + k) = 4.0 * (l[a] * dl.col(b) + l[b] * dl.col(a));
  }
  return g;
}

Eigen::Matrix<double, 6, 1> tri6_values(const Eigen::Vector2d& xi) {
  const double a = 1.0 - xi.sum(), b = xi[0], c = xi[1];
  Eigen::Matrix<double, 6, 1> n;
  n << a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1), 4 * a * b, 4 * b * c, 4 * c * a;
  return n;
}

Eigen::Matrix<double, 2, 6> tri6_reference_gradients(const Eigen::Vector2d& xi) {
  const double a = 1.0 - xi.sum(), b = xi[0], c = xi[1];
  Eigen::Matrix<double, 2, 6> g;
  g << 1 - 4 * a, 4 * b - 1, 0, 4 * (a - b), 4 * c, -4 * c,  //
      1 - 4 * a, 0, 4 * c - 1, -4 * b, 4 * b, 4 * (a - c);
  return g;
}

TetNodes tet_nodes(const TetMesh& mesh, int tet) {
  TetNodes x;
  for (int i = 0; i < kTetNodes; ++i) x.col(i) = mesh.nodes.row(mesh.tets(tet, i)).transpose();
  return x;
}

TetNodes tet_displacements(const TetMesh& mesh, int tet,
                           const Eigen::Ref<const Eigen::VectorXd>& displacement) {
  TetNodes u;
  for (int i = 0; i < kTetNodes; ++i) u.col(i) = displacement.segment<3>(3 * mesh.tets(tet, i));
  return u;
}

FaceNodes face_nodes(const TetMesh& mesh, int boundary_triangle) {
  FaceNodes x;
  for (int i = 0; i < 6; ++i) {
    x.col(i) = mesh.nodes.row(mesh.boundary(boundary_triangle, i)).transpose();
  }
  return x;
}

bool is_straight(const TetNodes& x) {
  for (int k = 0; k < 6; ++k) {
    const Eigen::Vector3d a = x.col(kTetEdges[k][0]), b = x.col(kTetEdges[k][1]);
    const double rounding = 1e-12 * (b - a).lpNorm<Eigen::Infinity>() +
                            4e-16 * (a.lpNorm<Eigen::Infinity>() + b.lpNorm<Eigen::Infinity>());
    if ((x.col(4 + k) - 0.5 * (a + b)).lpNorm<Eigen::Infinity>() > rounding) return false;
  }
  return true;
}

namespace {

// Reference gradients at the points of the two rules in use, computed once.
std::vector<TetGradients> reference_table(const TetRule& rule) {
  std::vector<TetGradients> table;
  for (const Eigen::Vector3d& p : rule.points) table.push_back(tet10_reference_gradients(p));
  return table;
}

const std::vector<TetGradients>& reference_gradients(const TetRule& rule) {
  static const std::vector<TetGradients> table_4 = reference_table(tet_rule_4());
  static const std::vector<TetGradients> table_14 = reference_table(tet_rule_14());
  return rule.points.size() == 4 ? table_4 : table_14;
}

}  // namespace

void evaluate_tet(const TetNodes& x, const TetRule& rule, TetPoints& out) {
  const std::vector<TetGradients>& table = reference_gradients(rule);
  const bool straight = is_straight(x);
  out.count = static_cast<int>(table.size());
  Eigen::Matrix3d inverse_transposed;
  double determinant = 0.0;
  for (std::size_t q = 0; q < table.size(); ++q) {
    if (q == 0 || !straight) {
      const Eigen::Matrix3d jacobian = table[q] * x.transpose();  // d x_j / d xi_i
      determinant = jacobian.determinant();
      inverse_transposed = jacobian.inverse();
    }
    out.gradients[q].noalias() = inverse_transposed * table[q];
    out.weights[q] = determinant * rule.weights[q];
  }
}

const TetRule& stiffness_rule(const TetNodes& x) {
  return is_straight(x) ? tet_rule_4() : tet_rule_14();
}

FacePoint evaluate_face(const FaceNodes& x, const Eigen::Vector2d& xi) {
  FacePoint p;
  p.values = tri6_values(xi);
  p.position = x * p.values;
  const Eigen::Matrix<double, 2, 6> g = tri6_reference_gradients(xi);
  const Eigen::Vector3d t1 = x * g.row(0).transpose(), t2 = x * g.row(1).transpose();
  p.area = t1.cross(t2);
  return p;
}

}  // namespace codesign::fem
