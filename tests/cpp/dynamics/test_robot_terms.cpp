#include <gtest/gtest.h>

#include <random>

#include "dynamics/plant.hpp"
#include "dynamics/robot_terms.hpp"
#include "flying_robot.hpp"

namespace codesign::dynamics {
namespace {

Eigen::VectorXd random_vector(std::mt19937_64& random, Eigen::Index n) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return Eigen::VectorXd::NullaryExpr(n, [&] { return uniform(random); });
}

RobotState random_state(const Model& model, std::mt19937_64& random) {
  RobotState state;
  state.base.p = random_vector(random, 3);
  state.base.R = exp_so3(2.0 * random_vector(random, 3));
  state.joints = random_vector(random, model.joint_count());
  state.velocity = random_vector(random, model.dofs());
  return state;
}

// Two jets along −z of their frames, two tilted propellers with drag torques of either sense.
class RobotTermsTest : public ::testing::TestWithParam<const char*> {
 protected:
  RobotTermsTest() {
    settings_.actuators[2].axis = Eigen::Vector3d(1.0, -2.0, 2.0) / 3.0;
    settings_.actuators[2].reaction = 0.02;
    settings_.actuators[3].axis = Eigen::Vector3d(0.6, 0.0, 0.8);
    settings_.actuators[3].reaction = -0.05;
  }

  Model model_ = testing::model(GetParam());
  FlightSettings settings_ = testing::settings();
  std::mt19937_64 random_{11};
};

TEST_P(RobotTermsTest, JetWrenchesAreTransposedJacobiansTimesThrust) {
  RobotTerms terms(model_, settings_.actuators);
  for (int trial = 0; trial < 5; ++trial) {
    update_terms(model_, random_state(model_, random_), terms);
    const Eigen::VectorXd thrusts = 100.0 * random_vector(random_, 4);
    Eigen::VectorXd force = Eigen::VectorXd::Zero(model_.dofs());
    add_jet_forces(model_, terms, thrusts, force);
    Eigen::VectorXd expected = Eigen::VectorXd::Zero(model_.dofs());
    for (std::size_t i = 0; i < terms.jets.size(); ++i) {
      Matrix6Xd J(6, model_.dofs());
      frame_jacobian(model_, terms.kin, terms.jets[i].frame, J);
      const Pose pose = frame_pose(model_, terms.kin, terms.jets[i].frame);
      const Actuator& actuator = settings_.actuators[i];
      EXPECT_LT((terms.jets[i].axis - pose.R * actuator.axis).norm(), 1e-14);
      Vector6d wrench;
      wrench << terms.jets[i].axis, actuator.reaction * terms.jets[i].axis;
      expected += J.transpose() * wrench * thrusts[static_cast<Eigen::Index>(i)];
    }
    EXPECT_LT((force - expected).norm(), 1e-12 * expected.norm());
  }
}

TEST_P(RobotTermsTest, JetMapIsTheRateOfTheMomentum) {
  RobotTerms terms(model_, settings_.actuators);
  JointSpace joint_space(model_.joint_count());
  for (int trial = 0; trial < 5; ++trial) {
    const RobotState state = random_state(model_, random_);
    update_terms(model_, state, terms);
    const Eigen::VectorXd thrusts = 100.0 * random_vector(random_, 4);
    Eigen::VectorXd force = -terms.bias;
    add_jet_forces(model_, terms, thrusts, force);
    ASSERT_TRUE(joint_space.set_mass_matrix(terms.mass_matrix));
    Eigen::VectorXd nu_dot(model_.dofs());
    joint_space.acceleration(10.0 * random_vector(random_, model_.joint_count()), force, nu_dot);
    VelocityData velocity(model_);
    forward_velocities(model_, terms.kin, state.velocity, velocity);
    InertiaData inertia(model_);
    compute_inertias(model_, terms.kin, inertia);
    const Vector6d rate = terms.momentum_matrix * nu_dot +
                          centroidal_momentum_bias(model_, terms.kin, inertia, velocity);
    Matrix6Xd A(6, 4);
    jet_map(terms, A);
    Vector6d expected = A * thrusts;
    expected[2] -= terms.robot.mass * kGravity;
    EXPECT_LT((rate - expected).norm(), 1e-9 * expected.norm());
  }
}

TEST_P(RobotTermsTest, LambdaIsTheDerivativeOfTheJetMapAlongAnyVelocity) {
  RobotTerms terms(model_, settings_.actuators), ahead(model_, settings_.actuators),
      behind(model_, settings_.actuators);
  for (int trial = 0; trial < 5; ++trial) {
    const RobotState state = random_state(model_, random_);
    const Eigen::VectorXd thrusts = 100.0 * random_vector(random_, 4);
    update_terms(model_, state, terms);
    Matrix6Xd Lambda(6, model_.dofs()), A(6, 4), A_ahead(6, 4), A_behind(6, 4);
    jet_map_rate(model_, terms, thrusts, Lambda);
    const double h = 1e-6;
    RobotState forward = state, backward = state;
    displace(h * state.velocity, forward);
    displace(-h * state.velocity, backward);
    update_terms(model_, forward, ahead);
    update_terms(model_, backward, behind);
    jet_map(ahead, A_ahead);
    jet_map(behind, A_behind);
    const Vector6d difference = (A_ahead - A_behind) * thrusts / (2.0 * h);
    EXPECT_LT((Lambda * state.velocity - difference).norm(), 1e-8 * thrusts.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(JointTypes, RobotTermsTest, ::testing::Values("revolute", "prismatic"));

}  // namespace
}  // namespace codesign::dynamics
