#include <gtest/gtest.h>

#include <cmath>

#include "fem/mesh/quadrature.hpp"

using namespace codesign::fem;

namespace {

double factorial(int n) { return n <= 1 ? 1.0 : n * factorial(n - 1); }

// Integral of x^a y^b z^c over the reference tetrahedron.
double exact(int a, int b, int c) {
  return factorial(a) * factorial(b) * factorial(c) / factorial(a + b + c + 3);
}

void expect_exact_up_to(const TetRule& rule, int degree) {
  for (int a = 0; a <= degree; ++a)
    for (int b = 0; a + b <= degree; ++b)
      for (int c = 0; a + b + c <= degree; ++c) {
        double sum = 0.0;
        for (std::size_t q = 0; q < rule.points.size(); ++q) {
          const Eigen::Vector3d& p = rule.points[q];
          sum += rule.weights[q] * std::pow(p[0], a) * std::pow(p[1], b) * std::pow(p[2], c);
        }
        EXPECT_NEAR(sum, exact(a, b, c), 1e-15) << a << b << c;
      }
}

void expect_exact_up_to(const TriangleRule& rule, int degree) {
  for (int a = 0; a <= degree; ++a)
    for (int b = 0; a + b <= degree; ++b) {
      double sum = 0.0;
      for (std::size_t q = 0; q < rule.points.size(); ++q) {
        sum += rule.weights[q] * std::pow(rule.points[q][0], a) * std::pow(rule.points[q][1], b);
      }
      EXPECT_NEAR(sum, factorial(a) * factorial(b) / factorial(a + b + 2), 1e-15) << a << b;
    }
}

}  // namespace

TEST(Quadrature, TetrahedronRulesIntegratePolynomialsExactly) {
  expect_exact_up_to(tet_rule_4(), 2);
  expect_exact_up_to(tet_rule_14(), 5);
}

TEST(Quadrature, TriangleRulesIntegratePolynomialsExactly) {
  expect_exact_up_to(triangle_rule_12(), 6);
  expect_exact_up_to(subdivided_triangle_rule(8), 1);
  EXPECT_EQ(subdivided_triangle_rule(8).points.size(), 64u);
}
