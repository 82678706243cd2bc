#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "dynamics/reference.hpp"
#include "dynamics/spatial.hpp"
#include "flying_robot.hpp"

namespace codesign::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

ReferenceGenerator generator(const FlightSettings& settings) {
  return ReferenceGenerator(settings, Vector3d(0.1, 0.2, 0.9),
                            rpy_to_rotation({0.0, 0.0, std::numbers::pi}));
}

TEST(Command, ActsStrictlyInsideItsWindow) {
  CommandWindow up;
  up.start = 10.0, up.end = 15.0, up.up = 1.0;
  CommandWindow down;
  down.start = 15.0, down.end = 16.0, down.up = -1.0;
  const std::vector<CommandWindow> trajectory{up, down};
  const double h = 0.008;
  EXPECT_EQ(command_at(trajectory, 1250, h).up, 0.0);
  EXPECT_EQ(command_at(trajectory, 1251, h).up, 1.0);
  EXPECT_EQ(command_at(trajectory, 1874, h).up, 1.0);
  EXPECT_EQ(command_at(trajectory, 1875, h).up, 0.0);  // touching windows: neither owns the border
  EXPECT_EQ(command_at(trajectory, 1876, h).up, -1.0);
  EXPECT_EQ(command_at(trajectory, 2000, h).up, 0.0);
}

TEST(Reference, HoversWithoutCommands) {
  const FlightSettings settings = testing::settings();
  ReferenceGenerator references = generator(settings);
  for (int k = 0; k < 200; ++k) {
    const Reference& r = references.update({});
    EXPECT_LT((r.position - Vector3d(0.1, 0.2, 0.9)).norm(), 1e-12);
    EXPECT_LT(r.jerk.norm(), 1e-6);
    EXPECT_LT(r.angular_velocity.norm(), 1e-12);
  }
}

TEST(Reference, ForwardFollowsTheBaseAndSettlesWhereTheSpeedsSay) {
  const FlightSettings settings = testing::settings();
  ReferenceGenerator references = generator(settings);
  Command forward;
  forward.front = 1.0;
  for (int k = 0; k < 250; ++k) references.update(forward);
  Reference r;
  for (int k = 0; k < 1000; ++k) r = references.update({});
  // Yaw π: forward is −x of the world.
  EXPECT_NEAR(r.position.x(), 0.1 - 250 * 0.008 * 0.9375, 1e-6);
  EXPECT_NEAR(r.position.y(), 0.2, 1e-9);
}

TEST(Reference, RollAndPitchStayWithinTheirLimits) {
  const FlightSettings settings = testing::settings();
  ReferenceGenerator references = generator(settings);
  Command command;
  command.pitch = 1.0, command.roll = -1.0;
  Reference r;
  for (int k = 0; k < 3000; ++k) r = references.update(command);
  const Vector3d rpy = rotation_to_rpy(r.rotation);
  EXPECT_NEAR(rpy.y(), 0.0, 1e-6);  // nose-down from level flight is not allowed
  EXPECT_NEAR(rpy.x(), settings.reference.roll_min, 1e-6);
}

TEST(Reference, RotationStaysARotationAndItsRateIsTheAngularVelocity) {
  FlightSettings settings = testing::settings();
  settings.step = 0.001;
  ReferenceGenerator references = generator(settings);
  Command command;
  command.yaw = 1.0;
  Matrix3d last = references.update(command).rotation;
  double lag = 0.0;
  for (int k = 1; k < 6000; ++k) {
    const Reference& r = references.update(command);
    // Explicit steps leave the rotations by (step ω)², the follower pulls back at 2/s: step ω²/2.
    ASSERT_LT((r.rotation.transpose() * r.rotation - Matrix3d::Identity()).norm(), 5e-4);
    const Vector3d rate = log_so3(last.transpose() * r.rotation) / settings.step;
    if (k > 3000) {
      EXPECT_LT((rate - r.angular_velocity).norm(), 2e-3);
    }
    last = r.rotation;
    lag = rotation_to_rpy(r.rotation).z();
  }
  // Steady yaw rate: the sine of the lag is rate over gain.
  const double raw = std::numbers::pi + 6000 * 0.001 * settings.command_speeds.yaw;
  EXPECT_NEAR(std::sin(raw - lag), settings.command_speeds.yaw, 0.02);  // still settling
}

}  // namespace
}  // namespace codesign::dynamics
