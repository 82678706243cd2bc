#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "dynamics/rigid_body.hpp"
#include "sample.hpp"

namespace codesign::dynamics {
namespace {

using namespace testing;

TEST(RigidBody, MassMatrixIsSymmetricAndPositiveDefinite) {
  for (const Model& model : models()) {
    const Eigen::MatrixXd M = Sample(model, random_state(model, 1)).M();
    EXPECT_EQ(M, M.transpose());
    EXPECT_EQ(M.llt().info(), Eigen::Success);
  }
}

TEST(RigidBody, MassMatrixOfAPendulumInClosedForm) {
  // 2 kg at 0.5 m from the axis, 0.02 kg m² about its own center.
  const Model model =
      load_urdf(robot(link("base") + link("bob", inertial(2.0, "0.5 0 0")) +
                      joint("turn", "revolute", "base", "bob", R"(<axis xyz="0 1 0"/>)")),
                {.fixed_base = true});
  Sample sample(model, {{}, Eigen::VectorXd::Constant(1, 0.3), Eigen::VectorXd::Constant(1, 5.0)});
  EXPECT_NEAR(sample.M()(0, 0), 0.02 + 2.0 * 0.25, 1e-15);
  EXPECT_NEAR(sample.bias()[0], -2.0 * kGravity * 0.5 * std::cos(0.3), 1e-14);
}

TEST(RigidBody, MassMatrixIsWhatInverseDynamicsSays) {
  for (const Model& model : models()) {
    Sample sample(model, random_state(model, 2));
    const Eigen::MatrixXd M = sample.M();
    const Eigen::VectorXd b = sample.bias();
    EXPECT_LT((sample.inverse(Eigen::VectorXd::Zero(model.dofs())) - b).norm(), 1e-12 * b.norm());
    for (int j = 0; j < model.dofs(); ++j) {
      const Eigen::VectorXd column = sample.inverse(Eigen::VectorXd::Unit(model.dofs(), j)) - b;
      EXPECT_LT((column - M.col(j)).norm(), 1e-11 * (b.norm() + M.col(j).norm()));
    }
  }
}

TEST(RigidBody, KineticEnergyIsHalfNuMNu) {
  for (const Model& model : models()) {
    const State state = random_state(model, 3);
    const Sample sample(model, state);
    const double energy = kinetic_energy(model, sample.kin, sample.inertia, sample.velocity);
    EXPECT_NEAR(0.5 * state.nu.dot(sample.M() * state.nu), energy, 1e-12 * energy);
  }
}

TEST(RigidBody, GravityIsTheBiasAtRestAndTheSlopeOfThePotential) {
  for (const Model& model : models()) {
    State state = random_state(model, 4);
    state.nu.setZero();
    Sample sample(model, state);
    const Eigen::VectorXd g = sample.gravity();
    EXPECT_LT(relative_error(sample.bias(), g), 1e-12);
    for (int j = 0; j < model.dofs(); ++j) {
      constexpr double kStep = 1e-5;
      State direction = state;
      direction.nu = Eigen::VectorXd::Unit(model.dofs(), j);
      const Sample next(model, moved(model, direction, kStep)),
          last(model, moved(model, direction, -kStep));
      const double slope =
          (potential_energy(next.kin, next.inertia) - potential_energy(last.kin, last.inertia)) /
          (2.0 * kStep);
      EXPECT_NEAR(slope, g[j], 1e-7 * (1.0 + g.norm()));
    }
  }
}

TEST(RigidBody, BiasForcesAreLagrangesFromTheMassMatrix) {
  // Without base: b = Ṁ ν - ½ ∂(νᵀMν)/∂s + g, the derivatives by central differences.
  constexpr double kStep = 1e-5;
  const Model model = load_urdf(random_robot(8, 7), {.fixed_base = true});
  const State state = random_state(model, 5);
  Sample sample(model, state);
  const Eigen::MatrixXd rate = (Sample(model, moved(model, state, kStep)).M() -
                                Sample(model, moved(model, state, -kStep)).M()) /
                               (2.0 * kStep);
  Eigen::VectorXd lagrange = rate * state.nu + sample.gravity();
  for (int j = 0; j < model.dofs(); ++j) {
    State next = state, last = state;
    next.s[j] += kStep;
    last.s[j] -= kStep;
    const Eigen::MatrixXd slope =
        (Sample(model, next).M() - Sample(model, last).M()) / (2.0 * kStep);
    lagrange[j] -= 0.5 * state.nu.dot(slope * state.nu);
  }
  EXPECT_LT(relative_error(sample.bias(), lagrange), 1e-8);
}

TEST(RigidBody, TurningTheWorldAboutTheVerticalTurnsTheBaseRows) {
  const Model model = load_urdf(random_robot(14, 1));
  const State state = random_state(model, 6);
  const Pose turn{exp_so3({0.0, 0.0, 1.1}), {3.0, -2.0, 7.0}};
  Eigen::MatrixXd Q = Eigen::MatrixXd::Identity(model.dofs(), model.dofs());
  Q.block<3, 3>(0, 0) = turn.R;
  Q.block<3, 3>(3, 3) = turn.R;
  Sample before(model, state), after(model, {turn * state.base, state.s, Q * state.nu});
  EXPECT_LT(relative_error(after.M(), Q * before.M() * Q.transpose()), 1e-14);
  EXPECT_LT(relative_error(after.bias(), Q * before.bias()), 1e-13);
}

TEST(RigidBody, MixedFormIsTheBodyFormTurnedByTheBase) {
  // With the base at rest in the world's axes, mixed and body velocities are the same; elsewhere
  // M = Q M_body Qᵀ with Q = blkdiag(R, R, 1).
  const Model model = load_urdf(random_robot(14, 2));
  const State state = random_state(model, 7);
  Eigen::MatrixXd Q = Eigen::MatrixXd::Identity(model.dofs(), model.dofs());
  Q.block<3, 3>(0, 0) = state.base.R;
  Q.block<3, 3>(3, 3) = state.base.R;
  const Sample body(model, {{}, state.s, Q.transpose() * state.nu}), mixed(model, state);
  EXPECT_LT(relative_error(mixed.M(), Q * body.M() * Q.transpose()), 1e-14);
  const int tip = static_cast<int>(model.frames.size()) - 1;
  Matrix6d R = Matrix6d::Zero();
  R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = state.base.R;
  EXPECT_LT(relative_error(mixed.jacobian(tip), R * body.jacobian(tip) * Q.transpose()), 1e-14);
  EXPECT_LT(relative_error(mixed.C(), R * body.C() * Q.transpose()), 1e-14);
}

TEST(RigidBody, FarFromTheWorldOriginNothingChanges) {
  const Model model = load_urdf(random_robot(14, 3));
  State state = random_state(model, 8);
  Sample near(model, state);
  state.base.p += Eigen::Vector3d(1e7, -1e7, 1e7);
  Sample far(model, state);
  EXPECT_EQ(near.M(), far.M());
  EXPECT_EQ(near.bias(), far.bias());
  EXPECT_EQ(near.C(), far.C());
}

TEST(RigidBody, AMirroredRobotMovesAsTheMirrorImage) {
  const Model model = load_urdf(random_robot(14, 4)), image = load_urdf(random_robot(14, 4, true));
  const Eigen::Vector3d place(1.0, -1.0, 1.0);
  Eigen::VectorXd flip = Eigen::VectorXd::Ones(model.dofs());
  flip.head<3>() = place;
  flip.segment<3>(3) = -place;
  const State state = random_state(model, 9);
  State mirrored{state.base, state.s, flip.asDiagonal() * state.nu};
  mirrored.base.p = place.asDiagonal() * state.base.p;
  mirrored.base.R = place.asDiagonal() * state.base.R * place.asDiagonal();
  Sample one(model, state), other(image, mirrored);
  EXPECT_LT(relative_error(other.M(), flip.asDiagonal() * one.M() * flip.asDiagonal()), 1e-13);
  EXPECT_LT(relative_error(other.bias(), flip.asDiagonal() * one.bias()), 1e-13);
  const Eigen::VectorXd tau = random_vector(model.joint_count(), 10);
  EXPECT_LT(relative_error(other.forward(tau), flip.asDiagonal() * one.forward(tau)), 1e-11);
}

TEST(RigidBody, AFixedBaseDropsTheBaseRows) {
  const std::string text = random_robot(14, 5);
  const Model floating = load_urdf(text), fixed = load_urdf(text, {.fixed_base = true});
  State state = random_state(floating, 11);
  state.nu.head<6>().setZero();
  const int n = fixed.joint_count();
  Sample a(floating, state), b(fixed, {state.base, state.s, state.nu.tail(n)});
  EXPECT_EQ(b.M(), a.M().bottomRightCorner(n, n));
  EXPECT_EQ(b.bias(), a.bias().tail(n));
  EXPECT_EQ(b.gravity(), a.gravity().tail(n));
  EXPECT_EQ(b.C(), a.C().rightCols(n));
  EXPECT_EQ(b.com_jacobian(), a.com_jacobian().rightCols(n));
}

TEST(RigidBody, TheOrderOfTheJointsIsAPermutation) {
  const std::string text = random_robot(14, 6);
  const Model model = load_urdf(text);
  std::vector<std::string> names;
  for (const Joint& joint : model.joints) names.insert(names.begin(), joint.name);
  const Model reversed = load_urdf(text, {.joints = names});
  const State state = random_state(model, 12);
  Eigen::VectorXd nu = state.nu;
  nu.tail(model.joint_count()).reverseInPlace();
  const Sample a(model, state), b(reversed, {state.base, state.s.reverse(), nu});
  const int n = model.joint_count();
  EXPECT_LT(relative_error(b.M().bottomRightCorner(n, n), a.M().bottomRightCorner(n, n).reverse()),
            1e-14);
}

}  // namespace
}  // namespace codesign::dynamics
