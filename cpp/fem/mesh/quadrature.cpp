#include "fem/mesh/quadrature.hpp"

#include <cmath>

namespace codesign::fem {

namespace {

// Orbits of a point under the symmetries of the tetrahedron, in barycentric coordinates.
void add_tet_orbit_31(TetRule& rule, double a, double weight) {  // (a, a, a, 1 - 3a)
  const double b = 1.0 - 3.0 * a;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(a, a, a), Eigen::Vector3d(b, a, a),
                                   Eigen::Vector3d(a, b, a), Eigen::Vector3d(a, a, b)}) {
    rule.points.push_back(p);
    rule.weights.push_back(weight / 6.0);
  }
}

void add_tet_orbit_22(TetRule& rule, double a, double weight) {  // (a, a, b, b), b = 1/2 - a
  const double b = 0.5 - a;
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(a, a, b), Eigen::Vector3d(a, b, a), Eigen::Vector3d(b, a, a),
        Eigen::Vector3d(a, b, b), Eigen::Vector3d(b, a, b), Eigen::Vector3d(b, b, a)}) {
    rule.points.push_back(p);
    rule.weights.push_back(weight / 6.0);
  }
}

void add_triangle_point(TriangleRule& rule, double a, double b, double weight) {
  rule.points.emplace_back(a, b);
  rule.weights.push_back(weight / 2.0);
}

void add_triangle_orbit_21(TriangleRule& rule, double a, double weight) {  // (a, a, 1 - 2a)
  add_triangle_point(rule, a, a, weight);
  add_triangle_point(rule, 1.0 - 2.0 * a, a, weight);
  add_triangle_point(rule, a, 1.0 - 2.0 * a, weight);
}

TetRule make_tet_rule_4() {
  TetRule rule;
  add_tet_orbit_31(rule, (5.0 - std::sqrt(5.0)) / 20.0, 0.25);
  return rule;
}

TetRule make_tet_rule_14() {
  TetRule rule;
  add_tet_orbit_31(rule, 0.31088591926330060980, 0.11268792571801585080);
  add_tet_orbit_31(rule, 0.092735250310891226402, 0.073493043116361949544);
  add_tet_orbit_22(rule, 0.045503704125649649492, 0.042546020777081466438);
  return rule;
}

TriangleRule make_triangle_rule_12() {
  TriangleRule rule;
  add_triangle_orbit_21(rule, 0.24928674517091042129, 0.11678627572637936603);
  add_triangle_orbit_21(rule, 0.063089014491502227690, 0.050844906370206816921);
  const double a = 0.053145049844816947353, b = 0.31035245103378440542, c = 1.0 - a - b;
  for (const auto& [p, q] : {std::pair(a, b), std::pair(b, a), std::pair(a, c), std::pair(c, a),
                             std::pair(b, c), std::pair(c, b)}) {
    add_triangle_point(rule, p, q, 0.082851075618373575194);
  }
  return rule;
}

}  // namespace

const TetRule& tet_rule_4() {
  static const TetRule rule = make_tet_rule_4();
  return rule;
}

const TetRule& tet_rule_14() {
  static const TetRule rule = make_tet_rule_14();
  return rule;
}

const TriangleRule& triangle_rule_12() {
  static const TriangleRule rule = make_triangle_rule_12();
  return rule;
}

TriangleRule subdivided_triangle_rule(int n) {
  TriangleRule rule;
  const double h = 1.0 / n;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      add_triangle_point(rule, h * (i + 1.0 / 3.0), h * (j + 1.0 / 3.0), h * h);
      if (i + j < n - 1) add_triangle_point(rule, h * (i + 2.0 / 3.0), h * (j + 2.0 / 3.0), h * h);
    }
  }
  return rule;
}

}  // namespace codesign::fem
