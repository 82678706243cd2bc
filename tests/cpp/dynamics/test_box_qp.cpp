#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>

#include "dynamics/qp/box_qp.hpp"

namespace codesign::dynamics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Problem {
  Eigen::MatrixXd H;
  Eigen::VectorXd g, lower, upper;
};

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

Eigen::MatrixXd random_matrix(std::mt19937_64& random, int rows, int cols) {
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return uniform(random, -1.0, 1.0); });
}

Eigen::VectorXd random_vector(std::mt19937_64& random, int n, double low, double high) {
  return Eigen::VectorXd::NullaryExpr(n, [&] { return uniform(random, low, high); });
}

// Q diag(1 … condition) Qᵀ, log-uniform spectrum with both ends taken.
Eigen::MatrixXd random_hessian(std::mt19937_64& random, int n, double condition) {
  const Eigen::MatrixXd q =
      Eigen::HouseholderQR<Eigen::MatrixXd>(random_matrix(random, n, n)).householderQ();
  Eigen::VectorXd values =
      random_vector(random, n, 0.0, std::log(condition)).array().exp().matrix();
  values[0] = 1.0;
  values[n - 1] = condition;
  const Eigen::MatrixXd half = q * values.cwiseSqrt().asDiagonal();
  return half * half.transpose();
}

// The families below mix what breaks active-set codes.
Problem make_problem(std::mt19937_64& random, int n, int family) {
  Problem p;
  p.H = random_hessian(random, n, family % 2 == 0 ? 1e2 : 1e10);
  p.g = random_vector(random, n, -1.0, 1.0);
  p.lower = random_vector(random, n, -1.0, 0.0);
  p.upper = random_vector(random, n, 0.0, 1.0);
  if (family >= 4) {  // a solution with many zero multipliers: doubly degenerate vertex
    const Eigen::VectorXd x = p.lower;
    p.g = -p.H * x;
    for (int i = 0; i < n; i += 3) p.g[i] += p.H(i, i);
  }
  for (int i = 0; i < n; ++i) {
    if (family == 2 || family == 3 || family == 7) {
      if (random() % 4 == 0) p.upper[i] = p.lower[i];
      if (random() % 4 == 0) p.lower[i] = -kInfinity;
      if (random() % 4 == 0 && p.lower[i] < p.upper[i]) p.upper[i] = kInfinity;
      if (!(p.lower[i] <= p.upper[i])) p.upper[i] = p.lower[i];
    }
  }
  if (family >= 6) {  // variables in wildly different units
    const Eigen::VectorXd units =
        random_vector(random, n, -6.0, 6.0).unaryExpr([](double e) { return std::pow(10.0, e); });
    p.H = (units.asDiagonal() * p.H * units.asDiagonal()).eval();
    p.g = p.g.cwiseProduct(units).eval();
    p.lower = p.lower.cwiseQuotient(units).eval();
    p.upper = p.upper.cwiseQuotient(units).eval();
  }
  return p;
}

// Optimality of x checked from the problem alone, in extended precision: the step x − P(x − D∇) of
// the diagonally scaled projected gradient must vanish, relative to the terms of the gradient.
double independent_residual(const Problem& p, const Eigen::VectorXd& x) {
  const Eigen::Index n = x.size();
  double worst = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    long double gradient = p.g[i];
    long double scale = std::abs(p.g[i]);
    for (Eigen::Index j = 0; j < n; ++j) {
      gradient += static_cast<long double>(p.H(i, j)) * x[j];
      scale += std::sqrt(static_cast<long double>(p.H(i, i)) * p.H(j, j)) * std::abs(x[j]);
    }
    if (x[i] < p.lower[i] || x[i] > p.upper[i]) return kInfinity;
    if (gradient > 0 && x[i] == p.lower[i]) continue;
    if (gradient < 0 && x[i] == p.upper[i]) continue;
    if (gradient != 0) worst = std::max(worst, static_cast<double>(std::abs(gradient) / scale));
  }
  return worst;
}

TEST(BoxQp, UnconstrainedMinimumInsideTheBoxSolvesTheLinearSystem) {
  std::mt19937_64 random(1);
  Problem p = make_problem(random, 8, 0);
  p.lower.setConstant(-kInfinity);
  p.upper.setConstant(kInfinity);
  BoxQpSolver solver(8);
  const BoxQpResult& r = solver.solve(p.H, p.g, p.lower, p.upper);
  EXPECT_EQ(r.status, QpStatus::kSolved);
  EXPECT_EQ(r.iterations, 1);
  EXPECT_LT((r.x + p.H.llt().solve(p.g)).norm(), 1e-13);
  EXPECT_EQ(r.multipliers.norm(), 0.0);
}

TEST(BoxQp, SeparableProblemIsAClampWithKnownMultipliers) {
  const Eigen::VectorXd h = (Eigen::VectorXd(4) << 2.0, 1.0, 4.0, 5.0).finished();
  const Eigen::MatrixXd H = h.asDiagonal();
  const Eigen::VectorXd g = (Eigen::VectorXd(4) << -8.0, 3.0, -1.0, 7.0).finished();
  const Eigen::VectorXd lower = (Eigen::VectorXd(4) << -1.0, -1.0, -1.0, 2.0).finished();
  const Eigen::VectorXd upper = (Eigen::VectorXd(4) << 1.0, 1.0, 1.0, 2.0).finished();
  BoxQpSolver solver(4);
  const BoxQpResult& r = solver.solve(H, g, lower, upper);
  ASSERT_EQ(r.status, QpStatus::kSolved);
  EXPECT_TRUE(r.x.isApprox((Eigen::VectorXd(4) << 1.0, -1.0, 0.25, 2.0).finished(), 1e-15));
  EXPECT_TRUE(
      r.multipliers.isApprox((Eigen::VectorXd(4) << -6.0, 2.0, 0.0, 17.0).finished(), 1e-15));
}

TEST(BoxQp, TenThousandRandomAndAdversarialProblemsMeetTheOptimalityConditions) {
  std::mt19937_64 random(7);
  int most_iterations = 0;
  for (int k = 0; k < 10000; ++k) {
    const int n = 1 + (k * 7) % 60;
    const Problem p = make_problem(random, n, k % 8);
    BoxQpSolver solver(n);
    const BoxQpResult& r = solver.solve(p.H, p.g, p.lower, p.upper);
    ASSERT_EQ(r.status, QpStatus::kSolved) << "problem " << k << " n " << n;
    ASSERT_LE(r.kkt_residual, 1e-9) << "problem " << k;
    ASSERT_LE(independent_residual(p, r.x), 1e-9) << "problem " << k << " n " << n;
    most_iterations = std::max(most_iterations, r.iterations);
  }
  EXPECT_LE(most_iterations, 200);
}

TEST(BoxQp, WarmStartFromTheSolutionNeedsOneFactorization) {
  std::mt19937_64 random(3);
  BoxQpSolver solver(27);
  const Problem p = make_problem(random, 27, 1);
  const Eigen::VectorXd first = solver.solve(p.H, p.g, p.lower, p.upper).x;
  const BoxQpResult& again = solver.solve(p.H, p.g, p.lower, p.upper);
  EXPECT_EQ(again.iterations, 1);
  EXPECT_EQ(again.x, first);
}

TEST(BoxQp, AnyWarmStartGivesTheSameSolution) {
  std::mt19937_64 random(4);
  BoxQpSolver warm(20);
  for (int k = 0; k < 500; ++k) {
    const Problem p = make_problem(random, 20, 2 * (k % 4));
    BoxQpSolver cold(20);
    const Eigen::VectorXd expected = cold.solve(p.H, p.g, p.lower, p.upper).x;
    const BoxQpResult& r = warm.solve(p.H, p.g, p.lower, p.upper);
    ASSERT_EQ(r.status, QpStatus::kSolved);
    const double difference = (r.x - expected).dot(p.H * (r.x - expected));
    ASSERT_LE(difference, 1e-20 * (1.0 + expected.dot(p.H * expected))) << k;
  }
}

// Damping over many decades, down to what leaves the tasks alone to decide.
TEST(BoxQp, AnObjectiveOfTasksHasTheSolutionOfItsHessian) {
  std::mt19937_64 random(9);
  for (int k = 0; k < 2000; ++k) {
    const int tasks = 1 + k % 12, n = 1 + (k * 7) % 40;
    const double least = std::pow(10.0, -(k % 10));
    const Eigen::VectorXd damping =
        random_vector(random, n, least, k % 3 == 0 ? 2.0 * least : 10.0);
    TaskObjective objective(tasks, n);
    objective.set_damping(damping);
    const Eigen::MatrixXd A = 30.0 * random_matrix(random, tasks, n);
    const Eigen::VectorXd offset = random_vector(random, tasks, -30.0, 30.0);
    const Eigen::VectorXd linear = random_vector(random, n, -1.0, 1.0);
    objective.scaled.topRows(tasks) = A * objective.unit().asDiagonal();
    objective.offset.head(tasks) = offset;
    objective.scaled_linear = linear.cwiseProduct(objective.unit());
    Eigen::MatrixXd H = A.transpose() * A;
    H.diagonal() += damping;
    const Problem p{H, A.transpose() * offset + linear, random_vector(random, n, -1.0, 0.0),
                    random_vector(random, n, 0.0, 1.0)};
    ASSERT_LT((objective.hessian() - p.H).norm(), 1e-13 * p.H.norm());
    ASSERT_LT((objective.linear() - p.g).norm(), 1e-12 * (p.g.norm() + offset.norm()));
    BoxQpSolver solver(n);
    const BoxQpResult& r = solver.solve(objective, p.lower, p.upper);
    ASSERT_EQ(r.status, QpStatus::kSolved) << k << ": " << tasks << " tasks, n " << n;
    ASSERT_LE(independent_residual(p, r.x), 1e-9) << k << ": " << tasks << " tasks, n " << n;
  }
}

TEST(BoxQp, SaysWhyItDidNotSolve) {
  BoxQpSolver solver(2);
  const Eigen::MatrixXd H = Eigen::Vector2d(1.0, 2.0).asDiagonal();
  const Eigen::Vector2d g(1.0, 1.0), lower(-1.0, -1.0), upper(1.0, 1.0);
  const auto status = [&](const Eigen::MatrixXd& h, const Eigen::Vector2d& gradient,
                          const Eigen::Vector2d& low) {
    return solver.solve(h, gradient, low, upper).status;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(status(H, g, lower), QpStatus::kSolved);
  EXPECT_EQ(status(-H, g, lower), QpStatus::kNotPositiveDefinite);
  EXPECT_EQ(status(nan * H, g, lower), QpStatus::kNotPositiveDefinite);
  EXPECT_EQ(status(H, Eigen::Vector2d(nan, 0.0), lower), QpStatus::kBadData);
  EXPECT_EQ(status(H, g, Eigen::Vector2d(2.0, 0.0)), QpStatus::kBadData);
  EXPECT_EQ(status(H, g, Eigen::Vector2d(nan, 0.0)), QpStatus::kBadData);
  EXPECT_EQ(status(H, g, lower), QpStatus::kSolved);
  EXPECT_THROW(solver.solve(H, Eigen::Vector3d::Zero(), lower, upper), std::invalid_argument);
  EXPECT_THROW(BoxQpSolver(-1), std::invalid_argument);
  BoxQpSolver empty(0);
  const Eigen::VectorXd nothing;
  EXPECT_EQ(empty.solve(Eigen::MatrixXd(), nothing, nothing, nothing).status, QpStatus::kSolved);
}

}  // namespace
}  // namespace codesign::dynamics
