#include <gtest/gtest.h>

#include "dynamics/kinematics.hpp"
#include "errors.hpp"
#include "sample.hpp"

namespace codesign::dynamics {
namespace {

using namespace testing;

constexpr double kStep =
    1e-5;  // of central differences: error about 1e-10 for quantities of order 1

TEST(Kinematics, PoseOfATwoLinkArmInClosedForm) {
  const std::string text =
      robot(link("base") + link("upper") + link("lower") + link("tip") +
            joint("shoulder", "revolute", "base", "upper",
                  R"(<origin xyz="0 0 1"/><axis xyz="0 1 0"/>)") +
            joint("slide", "prismatic", "upper", "lower",
                  R"(<origin xyz="0.5 0 0"/><axis xyz="-2 0 0"/>)") +
            joint("end", "fixed", "lower", "tip", R"(<origin xyz="0 0 0.1" rpy="0 0 0.3"/>)"));
  const Model model = load_urdf(text);
  KinematicsData kin(model);
  forward_kinematics(model, {}, Eigen::Vector2d(0.7, 0.2), kin);
  const Pose tip = frame_pose(model, kin, frame_index(model, "tip"));
  const double c = std::cos(0.7), s = std::sin(0.7);
  const Eigen::Vector3d expected(0.3 * c + 0.1 * s, 0.0, 1.0 - 0.3 * s + 0.1 * c);
  EXPECT_LT((tip.p - expected).norm(), 1e-15);
  EXPECT_LT((tip.R - rpy_to_rotation({0.0, 0.7, 0.0}) * rpy_to_rotation({0.0, 0.0, 0.3})).norm(),
            1e-15);
}

TEST(Kinematics, VelocityIsTheRateOfThePose) {
  for (const Model& model : models()) {
    const State state = random_state(model, 1);
    const Sample here(model, state), next(model, moved(model, state, kStep)),
        last(model, moved(model, state, -kStep));
    for (int frame = 0; frame < static_cast<int>(model.frames.size()); ++frame) {
      const Pose a = frame_pose(model, last.kin, frame), b = frame_pose(model, next.kin, frame);
      Vector6d rate;
      rate << (b.p - a.p) / (2.0 * kStep), log_so3(b.R * a.R.transpose()) / (2.0 * kStep);
      const Vector6d twist = frame_velocity(model, here.kin, here.velocity, frame);
      EXPECT_LT((rate - twist).norm(), 1e-6 * (1.0 + std::pow(twist.norm(), 3)));
      EXPECT_LT((here.jacobian(frame) * state.nu - twist).norm(), 1e-12 * (1.0 + twist.norm()));
    }
  }
}

TEST(Kinematics, BiasAccelerationIsTheRateOfTheVelocity) {
  for (const Model& model : models()) {
    const State state = random_state(model, 2);
    const Sample here(model, state), next(model, moved(model, state, kStep)),
        last(model, moved(model, state, -kStep));
    for (int frame = 0; frame < static_cast<int>(model.frames.size()); ++frame) {
      const Vector6d rate = (frame_velocity(model, next.kin, next.velocity, frame) -
                             frame_velocity(model, last.kin, last.velocity, frame)) /
                            (2.0 * kStep);
      const Vector6d bias = frame_bias_acceleration(model, here.kin, here.velocity, frame);
      const double speed = frame_velocity(model, here.kin, here.velocity, frame).norm();
      EXPECT_LT((rate - bias).norm(), 1e-6 * (1.0 + std::pow(speed, 4)));
    }
  }
}

TEST(Kinematics, ColumnsOfUnrelatedJointsAreZero) {
  const Model model = load_urdf(robot(link("base") + link("left") + link("right") +
                                      joint("l", "revolute", "base", "left") +
                                      joint("r", "revolute", "base", "right")));
  const Sample sample(model, random_state(model, 3));
  const Matrix6Xd J = sample.jacobian(frame_index(model, "left"));
  EXPECT_GT(J.col(6).norm(), 0.5);
  EXPECT_EQ(J.col(7).norm(), 0.0);
}

TEST(Kinematics, LockedJointsAreTheFullRobotAtZero) {
  const std::string text = random_robot(14, 6);
  const Model full = load_urdf(text);
  const Model part = load_urdf(text, {.joints = {{"joint6", "joint1"}}});
  State state = random_state(part, 4);
  State same{state.base, Eigen::VectorXd::Zero(full.joint_count()),
             Eigen::VectorXd::Zero(full.dofs())};
  same.s[joint_index(full, "joint6")] = state.s[0];
  same.s[joint_index(full, "joint1")] = state.s[1];
  const Sample a(part, state), b(full, same);
  for (const Frame& frame : part.frames) {
    const Pose p = frame_pose(part, a.kin, frame_index(part, frame.name));
    const Pose q = frame_pose(full, b.kin, frame_index(full, frame.name));
    EXPECT_LT((p.p - q.p).norm() + (p.R - q.R).norm(), 1e-14);
  }
}

TEST(Kinematics, UnknownNamesSayWhatThereIs) {
  const Model model = load_urdf(small_robot());
  EXPECT_EQ(frame_index(model, "tool"), 2);
  EXPECT_EQ(joint_index(model, "turn"), 0);
  try {
    frame_index(model, "gripper");
    FAIL();
  } catch (const UnknownNameError& e) {
    EXPECT_STREQ(e.what(), "robot \"test\" has no frame \"gripper\"; it has: base, arm, tool");
  }
  EXPECT_THROW(joint_index(model, "mount"), UnknownNameError);
}

}  // namespace
}  // namespace codesign::dynamics
