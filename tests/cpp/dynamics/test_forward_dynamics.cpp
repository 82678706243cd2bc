#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "dynamics/forward_dynamics.hpp"
#include "sample.hpp"

namespace codesign::dynamics {
namespace {

using namespace testing;

Eigen::VectorXd generalized(const Model& model, const Eigen::VectorXd& tau) {
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(model.dofs());
  forces.tail(model.joint_count()) = tau;
  return forces;
}

TEST(ForwardDynamics, UndoesInverseDynamics) {
  for (const Model& model : models()) {
    Sample sample(model, random_state(model, 1));
    const Eigen::VectorXd tau = random_vector(model.joint_count(), 2, 10.0);
    const Eigen::VectorXd forces = sample.inverse(sample.forward(tau));
    const double scale = sample.bias().norm() + tau.norm();
    EXPECT_LT((forces - generalized(model, tau)).norm(), 1e-9 * scale);
  }
}

TEST(ForwardDynamics, SolvesTheEquationsOfMotion) {
  for (const Model& model : models()) {
    Sample sample(model, random_state(model, 3));
    const Eigen::VectorXd tau = random_vector(model.joint_count(), 4, 10.0);
    const Eigen::VectorXd rhs = generalized(model, tau) - sample.bias();
    const Eigen::VectorXd expected = sample.M().partialPivLu().solve(rhs);
    EXPECT_LT(relative_error(sample.forward(tau), expected), 1e-10);
  }
}

TEST(ForwardDynamics, WrenchesActThroughTheFramesJacobians) {
  for (const Model& model : models()) {
    Sample sample(model, random_state(model, 5));
    const Eigen::VectorXd tau = random_vector(model.joint_count(), 6);
    const int last = static_cast<int>(model.frames.size()) - 1;
    // Two on one frame, one on another: they add up.
    const std::vector<FrameWrench> wrenches = {{last, random_vector(6, 7, 20.0)},
                                               {0, random_vector(6, 8, 20.0)},
                                               {last, random_vector(6, 9, 20.0)}};
    Eigen::VectorXd rhs = generalized(model, tau) - sample.bias();
    for (const FrameWrench& w : wrenches) rhs += sample.jacobian(w.frame).transpose() * w.wrench;
    const Eigen::VectorXd expected = sample.M().partialPivLu().solve(rhs);
    EXPECT_LT(relative_error(sample.forward(tau, wrenches), expected), 1e-10);
  }
}

TEST(ForwardDynamics, AFreeBodyFallsAndKeepsItsMomentum) {
  const Model model = load_urdf(random_robot(1, 1));
  const State state = random_state(model, 10);
  Sample sample(model, state);
  const Eigen::VectorXd nu_dot = sample.forward(Eigen::VectorXd(0));
  EXPECT_LT(
      (sample.com_jacobian() * nu_dot +
       centroidal_momentum_bias(model, sample.kin, sample.inertia, sample.velocity).head<3>() /
           model.total_mass -
       Eigen::Vector3d(0.0, 0.0, -kGravity))
          .norm(),
      1e-13);
}

TEST(ForwardDynamics, PowerIsTheRateOfTheEnergy) {
  constexpr double kStep = 1e-5;
  for (const Model& model : models()) {
    const State state = random_state(model, 11);
    Sample sample(model, state);
    const Eigen::VectorXd tau = random_vector(model.joint_count(), 12, 10.0);
    const Eigen::VectorXd nu_dot = sample.forward(tau);
    const auto energy_after = [&](double h) {
      State next = state;  // the position moves with the mean velocity: right to second order in h
      next.nu = state.nu + 0.5 * h * nu_dot;
      next = moved(model, next, h);
      next.nu = state.nu + h * nu_dot;
      return Sample(model, next).energy();
    };
    const double rate = (energy_after(kStep) - energy_after(-kStep)) / (2.0 * kStep);
    const double power = tau.dot(state.nu.tail(model.joint_count()));
    const double scale = std::abs(nu_dot.dot(sample.M() * state.nu)) + 1.0;
    EXPECT_NEAR(rate, power, 1e-5 * scale);
  }
}

// The arm turbines of the published robots: negative moments about both cross axes.
std::string indefinite_robot() {
  const std::string negative = R"(ixx="-0.6" ixy="0" ixz="0" iyy="-0.6" iyz="0" izz="0.000001")";
  return robot(
      link("base", inertial(20.0)) + link("arm", inertial(1.0, "0.1 0 0")) +
      link("jet", inertial(2.0, "0.2 0 0", negative)) +
      joint("shoulder", "revolute", "base", "arm", R"(<axis xyz="0 1 0"/>)") +
      joint("elbow", "revolute", "arm", "jet", R"(<origin xyz="0.3 0 0"/><axis xyz="0 0 1"/>)"));
}

TEST(ForwardDynamics, AcceptsAnIndefiniteMassMatrix) {
  const Model model = load_urdf(indefinite_robot(), {.as_published = true});
  Sample sample(model, random_state(model, 13));
  const Eigen::MatrixXd M = sample.M();
  ASSERT_LT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M).eigenvalues().minCoeff(), -0.1);
  const Eigen::VectorXd tau = random_vector(2, 14);
  const Eigen::VectorXd expected = M.partialPivLu().solve(generalized(model, tau) - sample.bias());
  EXPECT_LT(relative_error(sample.forward(tau), expected), 1e-11);
}

TEST(ForwardDynamics, KeepsTheDigitsOfALightFingerOnALongArm) {
  // 1 g finger with 1e-9 kg m² about its axis, 1 m from the base: 1e-9 of the inertia about the
  // base.
  const std::string tiny = R"(ixx="1e-9" ixy="0" ixz="0" iyy="1e-9" iyz="0" izz="1e-9")";
  const Model model = load_urdf(robot(
      link("base") + link("arm") + link("finger", inertial(0.001, "0 0 0", tiny)) +
      joint("shoulder", "revolute", "base", "arm") +
      joint("finger", "revolute", "arm", "finger", R"(<origin xyz="1 0 0"/><axis xyz="0 0 1"/>)")));
  State state = random_state(model, 15);
  const Sample sample(model, state);
  EXPECT_NEAR(sample.M()(7, 7) / 1e-9, 1.0, 1e-13);
}

TEST(ForwardDynamics, ASingularMassMatrixGivesNoNumbers) {
  // A straight wrist without mass between its rolls, which are then one.
  const auto axis = [](const char* xyz) { return std::string("<axis xyz=\"") + xyz + "\"/>"; };
  const Model model =
      load_urdf(robot(link("base") + link("first", "") + link("second", "") + link("hand") +
                      joint("roll", "continuous", "base", "first", axis("1 0 0")) +
                      joint("pitch", "continuous", "first", "second", axis("0 1 0")) +
                      joint("turn", "continuous", "second", "hand", axis("1 0 0"))));
  auto state = random_state(model, 16);
  state.s.setZero();
  Sample sample(model, state);
  EXPECT_FALSE(sample.forward(Eigen::VectorXd::Ones(3)).allFinite());
}

}  // namespace
}  // namespace codesign::dynamics
