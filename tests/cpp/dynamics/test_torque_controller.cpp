#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "dynamics/torque_controller.hpp"
#include "flying_robot.hpp"

namespace codesign::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Case {
  MatrixXd M;  // (6+n, 6+n)
  VectorXd force, velocity, command;
};

Case random_case(std::mt19937_64& random, int n, bool indefinite) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto draw = [&](int rows, int cols) -> MatrixXd {
    return MatrixXd::NullaryExpr(rows, cols, [&] { return uniform(random); });
  };
  Case c;
  const MatrixXd half = draw(6 + n, 6 + n);
  c.M = half * half.transpose() + 0.05 * MatrixXd::Identity(6 + n, 6 + n);
  if (indefinite) c.M(6, 6) -= 10.0;
  c.force = 5.0 * draw(6 + n, 1);
  c.velocity = draw(n, 1);
  c.command = draw(n, 1);
  return c;
}

class JointSpaceTest : public ::testing::TestWithParam<bool> {};

TEST_P(JointSpaceTest, AgreesWithTheFullSystem) {
  std::mt19937_64 random(2);
  const int n = 9;
  JointSpace joint_space(n);
  for (int trial = 0; trial < 10; ++trial) {
    const Case c = random_case(random, n, GetParam());
    ASSERT_TRUE(joint_space.set_mass_matrix(c.M));
    VectorXd nu_dot(6 + n), generalized = c.force;
    joint_space.acceleration(c.velocity, c.force, nu_dot);
    generalized.tail(n) += c.velocity;
    EXPECT_LT((c.M * nu_dot - generalized).norm(), 1e-11 * c.M.norm() * nu_dot.norm());
    const MatrixXd W = c.M.inverse().bottomRightCorner(n, n);
    EXPECT_LT((joint_space.joint_inertia() * W - MatrixXd::Identity(n, n)).norm(), 1e-9 * W.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(Definite, JointSpaceTest, ::testing::Values(false, true));

TEST(JointSpace, RefusesASingularOrInvalidMassMatrix) {
  JointSpace joint_space(2);
  EXPECT_FALSE(joint_space.set_mass_matrix(MatrixXd::Zero(8, 8)));
  MatrixXd M = MatrixXd::Identity(8, 8);
  M(6, 6) = M(7, 7) = M(6, 7) = M(7, 6) = -1.0;
  EXPECT_FALSE(joint_space.set_mass_matrix(M));
  EXPECT_FALSE(joint_space.set_mass_matrix(MatrixXd::Constant(8, 8, std::nan(""))));
}

class TorqueControllerTest : public ::testing::TestWithParam<bool> {
 protected:
  FlightSettings settings_ = testing::settings();
  static constexpr int kJoints = 6;
  double limit_ = 1e9;

  // First torque, from the formulation of the specification with the explicit W.
  VectorXd expected(const Case& c) const {
    const MatrixXd W = c.M.inverse().bottomRightCorner(kJoints, kJoints);
    const VectorXd s0 = c.M.lu().solve(c.force).tail(kJoints);
    const VectorXd wanted = -2.0 * std::sqrt(50.0) * (c.velocity - c.command);
    const MatrixXd H = W * W + 1.1e-3 * MatrixXd::Identity(kJoints, kJoints);
    const VectorXd g = W * (s0 - wanted);
    BoxQpSolver solver(kJoints);
    return solver
        .solve(0.5 * (H + H.transpose()), g, VectorXd::Constant(kJoints, -limit_),
               VectorXd::Constant(kJoints, limit_))
        .x;
  }
};

TEST_P(TorqueControllerTest, SolvesTheRegularizedLeastSquaresWithinTheLimits) {
  std::mt19937_64 random(3);
  for (const double limit : {1e9, 2.0}) {
    limit_ = settings_.limits.torque = limit;
    for (int trial = 0; trial < 20; ++trial) {
      const Case c = random_case(random, kJoints, GetParam());
      JointSpace joint_space(kJoints);
      ASSERT_TRUE(joint_space.set_mass_matrix(c.M));
      VectorXd joint_force(kJoints);
      joint_space.reduce_force(c.force, joint_force);
      TorqueController controller(settings_);
      ASSERT_EQ(controller.update(joint_space, joint_force, c.velocity, c.command),
                QpStatus::kSolved);
      const VectorXd reference = expected(c);
      EXPECT_LT((controller.torque() - reference).norm(), 1e-7 * reference.norm());
      EXPECT_LE(controller.torque().cwiseAbs().maxCoeff(), limit);
    }
  }
}

TEST_P(TorqueControllerTest, LimitsTheRateAfterTheFirstTorqueAndIntegratesTheErrorAfterUse) {
  std::mt19937_64 random(4);
  const Case c = random_case(random, kJoints, GetParam());
  JointSpace joint_space(kJoints);
  ASSERT_TRUE(joint_space.set_mass_matrix(c.M));
  const VectorXd zero = VectorXd::Zero(kJoints);
  TorqueController controller(settings_);
  controller.update(joint_space, zero, zero, zero);
  EXPECT_LT(controller.torque().norm(), 1e-14);
  controller.update(joint_space, VectorXd::Constant(kJoints, 1e3), zero, zero);
  EXPECT_NEAR(controller.torque().cwiseAbs().maxCoeff(), 300.0 * settings_.step, 1e-12);

  // e_0 = 0 at the first use; e_1 = h (ṡ − ṡ*) at the second.
  TorqueController integrating(settings_);
  settings_.limits.torque_rate = 1e9;
  integrating = TorqueController(settings_);
  integrating.update(joint_space, zero, c.velocity, zero);
  integrating.update(joint_space, zero, zero, zero);
  const MatrixXd& inertia = joint_space.joint_inertia();
  const VectorXd wanted = -50.0 * settings_.step * c.velocity;
  const VectorXd expected = (MatrixXd::Identity(kJoints, kJoints) + 1.1e-3 * inertia * inertia)
                                .lu()
                                .solve(inertia * wanted);
  EXPECT_LT((integrating.torque() - expected).norm(), 1e-10 * expected.norm());
}

INSTANTIATE_TEST_SUITE_P(Definite, TorqueControllerTest, ::testing::Values(false, true));

}  // namespace
}  // namespace codesign::dynamics
