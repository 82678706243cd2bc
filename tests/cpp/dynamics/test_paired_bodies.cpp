#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "dynamics/paired/paired_bodies.hpp"
#include "sample.hpp"

namespace codesign::dynamics {
namespace {

using namespace testing;
using Eigen::Vector3d;

// The robots of the other tests whose base floats and whose bodies share no joint.
std::vector<Model> floating_trees() {
  std::vector<Model> result;
  for (const Model& model : models()) {
    if (!model.fixed_base && !model.mimics) result.push_back(model);
  }
  return result;
}

Eigen::VectorXd accelerated(PairedBodies& bodies, const State& state, const Eigen::VectorXd& tau) {
  Eigen::VectorXd nu_dot(state.nu.size());
  EXPECT_TRUE(bodies.accelerate(tau, nu_dot));
  return nu_dot;
}

TEST(PairedBodies, SolveTheEquationsOfMotion) {
  ASSERT_GT(floating_trees().size(), 3U);
  for (const Model& model : floating_trees()) {
    const State state = random_state(model, 3);
    Sample sample(model, state);
    const Eigen::VectorXd tau = random_vector(model.joint_count(), 4, 10.0);
    PairedBodies bodies(model, {});
    bodies.move(state.base.R, state.s, state.nu);
    EXPECT_LT(relative_error(accelerated(bodies, state, tau), sample.forward(tau)), 1e-10);
  }
}

TEST(PairedBodies, MoveWithAnotherOfOtherMassesAsAlone) {
  for (const Model& model : floating_trees()) {
    const State state = random_state(model, 6);
    Model heavier = model;
    for (Body& body : heavier.bodies) body.inertia.mass *= 1.1;
    const Eigen::VectorXd tau = random_vector(model.joint_count(), 7, 10.0);
    PairedBodies moved(model, {}), alone(heavier, {}), together(heavier, {});
    moved.move(state.base.R, state.s, state.nu);
    alone.move(state.base.R, state.s, state.nu);
    together.move_with(moved);
    EXPECT_EQ(accelerated(together, state, tau), accelerated(alone, state, tau));
  }
}

TEST(PairedBodies, ForcesOnBodiesActThroughTheirJacobians) {
  for (const Model& model : floating_trees()) {
    const State state = random_state(model, 5);
    Sample sample(model, state);
    const Eigen::VectorXd tau = random_vector(model.joint_count(), 6);
    PairedBodies bodies(model, {});
    bodies.move(state.base.R, state.s, state.nu);
    std::vector<FrameWrench> wrenches;
    for (int frame = 0; frame < static_cast<int>(model.frames.size()); ++frame) {
      const Vector6d wrench = random_vector(6, static_cast<unsigned>(7 + frame), 20.0);
      wrenches.push_back({frame, wrench});
      const Frame& at = model.frames[static_cast<std::size_t>(frame)];
      const Vector3d arm = bodies.rotation(at.body) * at.body_T_frame.p;
      bodies.push(at.body, wrench.head<3>(), wrench.tail<3>() + arm.cross(wrench.head<3>()));
    }
    EXPECT_LT(relative_error(accelerated(bodies, state, tau), sample.forward(tau, wrenches)),
              1e-10);
  }
}

TEST(PairedBodies, RotorsAddToTheDiagonal) {
  for (const Model& model : floating_trees()) {
    if (model.joint_count() == 0) continue;
    const State state = random_state(model, 8);
    Sample sample(model, state);
    const Eigen::VectorXd rotors = random_vector(model.joint_count(), 9).cwiseAbs();
    const Eigen::VectorXd tau = random_vector(model.joint_count(), 10);
    Eigen::MatrixXd M = sample.M();
    M.diagonal().tail(model.joint_count()) += rotors;
    Eigen::VectorXd forces = -sample.bias();
    forces.tail(model.joint_count()) += tau;
    PairedBodies bodies(model, rotors);
    bodies.move(state.base.R, state.s, state.nu);
    EXPECT_LT(relative_error(accelerated(bodies, state, tau), M.partialPivLu().solve(forces)),
              1e-10);
  }
}

TEST(PairedBodies, GeneralizedForcesAreThoseOfTheEquationsOfMotion) {
  for (const Model& model : floating_trees()) {
    const State state = random_state(model, 14);
    Sample sample(model, state);
    PairedBodies bodies(model, {});
    bodies.move(state.base.R, state.s, state.nu);
    const int frame = static_cast<int>(model.frames.size()) - 1;
    const Frame& at = model.frames.back();
    const Vector6d wrench = random_vector(6, 15, 20.0);
    const Vector3d force = wrench.head<3>(), arm = bodies.rotation(at.body) * at.body_T_frame.p;
    bodies.push(at.body, force, wrench.tail<3>() + arm.cross(force));
    Eigen::VectorXd found(model.dofs());
    bodies.generalized_forces(found);
    const Eigen::VectorXd expected = sample.jacobian(frame).transpose() * wrench - sample.bias();
    EXPECT_LT(relative_error(found, expected), 1e-12);
  }
}

TEST(Lanes, SineAndCosineAreThoseOfTheLibrary) {
  for (int i = -4000; i <= 4000; ++i) {
    const double first = 0.00731 * i, second = 23.7 * i;
    Lanes sine, cosine;
    sine_cosine(lanes(first, second), sine, cosine);
    EXPECT_NEAR(sine[0], std::sin(first), 3e-16);
    EXPECT_NEAR(cosine[0], std::cos(first), 3e-16);
    EXPECT_NEAR(sine[1], std::sin(second), 1e-15);
    EXPECT_NEAR(cosine[1], std::cos(second), 1e-15);
  }
  Lanes sine, cosine;
  sine_cosine(lanes(1e9, 0.5), sine, cosine);
  EXPECT_EQ(sine[0], std::sin(1e9));
}

TEST(Lanes, TheHyperbolicTangentIsThatOfTheLibrary) {
  for (int i = -4000; i <= 4000; ++i) {
    const double first = 0.00731 * i, second = 1e-6 * i;
    const Lanes found = hyperbolic_tangent(lanes(first, second));
    EXPECT_NEAR(found[0], std::tanh(first), 4e-16);
    EXPECT_NEAR(found[1], std::tanh(second), 4e-16);
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Lanes ends = hyperbolic_tangent(lanes(-kInfinity, 1e300));
  EXPECT_EQ(ends[0], -1.0);
  EXPECT_EQ(ends[1], 1.0);
  EXPECT_EQ(hyperbolic_tangent(lanes(0.0, 0.0))[0], 0.0);
  EXPECT_TRUE(std::isnan(hyperbolic_tangent(lanes(std::nan(""), 1.0))[0]));
}

TEST(PairedBodies, AreWhereTheKinematicsHaveThem) {
  for (const Model& model : floating_trees()) {
    const State state = random_state(model, 11);
    Sample sample(model, state);
    PairedBodies bodies(model, {});
    bodies.move(state.base.R, state.s, state.nu);
    for (int i = 0; i < model.body_count(); ++i) {
      const auto index = static_cast<std::size_t>(i);
      EXPECT_LT((bodies.rotation(i) - sample.kin.bodies[index].R).norm(), 1e-13);
      EXPECT_LT((bodies.origin(i) - sample.kin.bodies[index].p).norm(), 1e-13);
      const BodyVelocity& v = sample.velocity.bodies[index];
      EXPECT_LT((bodies.linear_velocity(i) - v.linear).norm(), 1e-12);
      EXPECT_LT((bodies.angular_velocity(i) - v.angular).norm(), 1e-12);
    }
    EXPECT_LT((bodies.center_of_mass() - sample.inertia.subtrees[0].com).norm(), 1e-13);
  }
}

TEST(PairedBodies, HaveTheMassMatrixAndTheMomentumMatrixOfTheTree) {
  for (const Model& model : floating_trees()) {
    const State state = random_state(model, 16);
    Sample sample(model, state);
    const Eigen::VectorXd rotors = random_vector(model.joint_count(), 17).cwiseAbs();
    PairedBodies bodies(model, rotors);
    bodies.move(state.base.R, state.s, state.nu);
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(model.dofs(), model.dofs());
    Matrix6Xd C = Matrix6Xd::Zero(6, model.dofs()), expected_C = C;
    RigidInertia robot;
    bodies.write_mass_matrix(M, C, robot);
    Eigen::MatrixXd expected = sample.M();
    expected.diagonal().tail(model.joint_count()) += rotors;
    centroidal_momentum_matrix(model, sample.kin, sample.inertia, expected_C);
    EXPECT_LT(relative_error(M, expected), 1e-13);
    EXPECT_EQ(M, M.transpose());
    EXPECT_LT(relative_error(C, expected_C), 1e-13);
    const RigidInertia& all = sample.inertia.subtrees[0];
    EXPECT_NEAR(robot.mass, all.mass, 1e-13 * all.mass);
    EXPECT_LT((robot.com - all.com).norm(), 1e-13);
    EXPECT_LT((robot.inertia - all.inertia).norm(), 1e-12 * all.inertia.norm());
    std::vector<BodyPose> poses(model.bodies.size());
    bodies.write_poses(poses);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      EXPECT_LT((poses[i].R - sample.kin.bodies[i].R).norm(), 1e-13);
      EXPECT_LT((poses[i].p - sample.kin.bodies[i].p).norm(), 1e-13);
      EXPECT_LT((poses[i].offset - sample.kin.bodies[i].offset).norm(), 1e-13);
    }
  }
}

TEST(PairedBodies, TakeAnotherInertia) {
  for (Model model : floating_trees()) {
    const State state = random_state(model, 12);
    const Eigen::VectorXd tau = random_vector(model.joint_count(), 13);
    PairedBodies bodies(model, {});
    const int last = model.body_count() - 1;
    RigidInertia& own = model.bodies.back().inertia;
    own = own + RigidInertia{2.0, Vector3d(0.1, -0.2, 0.3), Eigen::Matrix3d::Zero()};
    bodies.set_inertia(last, own);
    bodies.move(state.base.R, state.s, state.nu);
    Sample sample(model, state);
    EXPECT_LT(relative_error(accelerated(bodies, state, tau), sample.forward(tau)), 1e-10);
  }
}

}  // namespace
}  // namespace codesign::dynamics
