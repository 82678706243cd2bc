#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/flight/flight.hpp"
#include "flying_robot.hpp"

namespace codesign::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;

TEST(Flight, FollowsItsTrajectory) {
  FlightSettings settings = testing::settings();
  settings.duration = 12.0;
  const FlightLog log = simulate_flight(testing::model(), settings);
  ASSERT_EQ(log.status, FlightStatus::kCompleted);
  EXPECT_EQ(log.samples, 1501);
  EXPECT_EQ(log.qp_failures, 0);
  const Vector3d moved = (log.com.row(1500) - log.com_reference.row(0)).transpose();
  EXPECT_NEAR(moved.x(), 0.9375, 0.01);
  EXPECT_NEAR(moved.y(), 0.5 * 0.3125, 0.01);
  EXPECT_NEAR(moved.z(), 0.9375, 0.01);
  EXPECT_LT(log.max_com_error, 0.3);
  EXPECT_LT(log.max_attitude_error, 0.6);
  const double weight = testing::model().total_mass * kGravity;
  EXPECT_NEAR(log.thrust.row(1500).sum(), weight, 0.05 * weight);
}

TEST(Flight, FirstStepIsAFreeFallIfAsked) {
  FlightSettings settings = testing::settings();
  settings.duration = 0.08;
  const FlightLog falling = simulate_flight(testing::model(), settings);
  EXPECT_NEAR(falling.velocity(0, 2), -0.07848, 1e-12);
  EXPECT_EQ(falling.joint_positions.row(0).transpose(), settings.initial_joints);
  settings.initial_free_fall = false;
  const FlightLog held = simulate_flight(testing::model(), settings);
  EXPECT_EQ(held.velocity.row(0).norm(), 0.0);
}

TEST(Flight, IsDeterministic) {
  FlightSettings settings = testing::settings();
  settings.disturbances.gust_deviation.setConstant(3.0);
  settings.disturbances.mass_deviation = 0.02;
  settings.disturbances.thrust_deviation = 0.02;
  const FlightLog first = simulate_flight(testing::model(), settings);
  const FlightLog second = simulate_flight(testing::model(), settings);
  EXPECT_EQ(first.velocity, second.velocity);
  EXPECT_EQ(first.thrust, second.thrust);
  settings.disturbances.seed = 1;
  EXPECT_NE(simulate_flight(testing::model(), settings).velocity, first.velocity);
}

// Mirrored at the plane y = 0: the right side does what the left did, yaw and left commands change
// sign. The robot's right arm has mirrored roll axes, so joint values swap without a sign.
TEST(Flight, MirroredCommandsGiveTheMirroredFlight) {
  const Model model = testing::model();
  FlightSettings settings = testing::settings();
  settings.initial_joints << -0.1, 0.25, -0.1, -0.05, 0.15, -0.15;
  settings.initial_thrusts << 95.0, 105.0, 100.0, 98.0;
  FlightSettings mirrored = settings;
  mirrored.initial_joints << -0.05, 0.15, -0.15, -0.1, 0.25, -0.1;
  mirrored.initial_thrusts << 105.0, 95.0, 98.0, 100.0;
  for (CommandWindow& window : mirrored.trajectory) {
    window.left = -window.left, window.yaw = -window.yaw, window.roll = -window.roll;
  }
  const FlightLog a = simulate_flight(model, settings);
  const FlightLog b = simulate_flight(model, mirrored);
  ASSERT_EQ(a.status, FlightStatus::kCompleted);
  ASSERT_EQ(b.status, FlightStatus::kCompleted);
  const Vector3d reflect(1.0, -1.0, 1.0);
  EXPECT_LT((a.com * reflect.asDiagonal() - b.com).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((a.joint_positions.leftCols(3) - b.joint_positions.rightCols(3)).cwiseAbs().maxCoeff(),
            1e-8);
  EXPECT_LT((a.thrust.col(0) - b.thrust.col(1)).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_LT((a.thrust.col(2) - b.thrust.col(3)).cwiseAbs().maxCoeff(), 1e-5);
  const double yaw_a =
      std::atan2(a.base_rotation(a.samples - 1, 3), a.base_rotation(a.samples - 1, 0));
  const double yaw_b =
      std::atan2(b.base_rotation(b.samples - 1, 3), b.base_rotation(b.samples - 1, 0));
  EXPECT_GT(yaw_a, 0.5);
  EXPECT_NEAR(yaw_a, -yaw_b, 1e-8);
}

TEST(Flight, DoesNotDependOnWhereAndWhichWayItStarts) {
  const Model model = testing::model();
  FlightSettings settings = testing::settings();
  const FlightLog here = simulate_flight(model, settings);
  settings.base_pose.topLeftCorner<3, 3>() = exp_so3(Vector3d(0.0, 0.0, 2.0));
  settings.base_pose.topRightCorner<3, 1>() << 50.0, -20.0, 30.0;
  const FlightLog there = simulate_flight(model, settings);
  EXPECT_NEAR(here.rms.momentum, there.rms.momentum, 1e-9);
  EXPECT_NEAR(here.rms.joint_velocity, there.rms.joint_velocity, 1e-9);
  EXPECT_LT((here.joint_positions - there.joint_positions).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Flight, ReportsALossWithItsTimeAndReason) {
  FlightSettings settings = testing::settings();
  for (Actuator& jet : settings.actuators) jet.thrust_max = 60.0;  // 240 N for 38 kg: it falls
  settings.initial_thrusts.setConstant(60.0);
  settings.failure.attitude_error = 3.0;
  const FlightLog log = simulate_flight(testing::model(), settings);
  EXPECT_EQ(log.status, FlightStatus::kFailed);
  EXPECT_EQ(log.failure_reason, FailureReason::kComError);
  EXPECT_GT(log.failure_time, 0.5);
  EXPECT_EQ(log.samples, log.com.rows());
  EXPECT_NEAR(log.failure_time, log.time(log.samples - 1, 0), 1e-12);
  EXPECT_GT(log.max_com_error, 2.0);
  EXPECT_TRUE(log.ground_touched);
}

TEST(Flight, TurbineJetsFollowTheCommandedRates) {
  FlightSettings settings = testing::settings();
  Turbine turbine;
  turbine.K_T = -30.0, turbine.K_D = -2.0, turbine.B_U = 100.0, turbine.B_UU = 0.001;
  for (Actuator& jet : settings.actuators) jet.dynamics = turbine;
  settings.duration = 12.0;
  const FlightLog log = simulate_flight(testing::model(), settings);
  ASSERT_EQ(log.status, FlightStatus::kCompleted);
  EXPECT_GE(log.thrust_command.minCoeff(), 0.0);
  EXPECT_LE(log.thrust_command.maxCoeff(), 120.0);
  const double weight = testing::model().total_mass * kGravity;
  EXPECT_NEAR(log.thrust.row(log.samples - 1).sum(), weight, 0.05 * weight);
}

// The controller does not know the force F: it settles where K_P m e = (1 + K_D) F.
TEST(Flight, SteadyWindLeavesTheOffsetThatTheGainsImply) {
  FlightSettings settings = testing::settings();
  settings.duration = 20.0;
  settings.trajectory.clear();
  settings.disturbances.wind_force = Vector3d(2.0, 0.0, -1.0);
  const Model model = testing::model();
  const FlightLog log = simulate_flight(model, settings);
  ASSERT_EQ(log.status, FlightStatus::kCompleted);
  EXPECT_EQ(log.wind(10, 0), 2.0);
  const int end = log.samples - 1;
  const Vector3d offset = (log.com.row(end) - log.com_reference.row(end)).transpose();
  const double compliance = (1.0 + 2.5 * std::sqrt(1.5)) / (1.5 * model.total_mass);
  EXPECT_NEAR(offset.x(), 2.0 * compliance, 0.002);
  EXPECT_NEAR(offset.y(), 0.0, 0.002);
  EXPECT_NEAR(offset.z(), -1.0 * compliance, 0.002);
}

TEST(Flight, RefusesSettingsThatDoNotFit) {
  const Model model = testing::model();
  const auto refused = [&](auto change) {
    FlightSettings settings = testing::settings();
    change(settings);
    EXPECT_THROW(simulate_flight(model, settings), std::invalid_argument);
  };
  refused([](FlightSettings& s) { s.step = 0.0; });
  refused([](FlightSettings& s) { s.duration = 4.001; });
  refused([](FlightSettings& s) { s.joints.pop_back(); });
  refused([](FlightSettings& s) { std::swap(s.joints[0], s.joints[1]); });
  refused([](FlightSettings& s) { s.initial_joints.resize(5); });
  refused([](FlightSettings& s) { s.initial_thrusts[0] = std::nan(""); });
  refused([](FlightSettings& s) { s.symmetry_pairs = {{0, 4}}; });
  refused([](FlightSettings& s) { s.actuators[1].axis *= 2.0; });
  refused([](FlightSettings& s) { s.actuators[1].thrust_min = 300.0; });
  refused([](FlightSettings& s) { s.actuators[1].dynamics = FirstOrderLag{0.0}; });
  refused([](FlightSettings& s) { s.groups[0].joints = {"nothing"}; });
  refused([](FlightSettings& s) { s.base_pose(0, 0) = 2.0; });
  refused([](FlightSettings& s) { s.limits.joint_lower[2] = 5.0; });
  refused([](FlightSettings& s) { s.disturbances.mass_deviation = 0.5; });
  refused([](FlightSettings& s) { s.trajectory[0].end = s.trajectory[0].start; });
  FlightSettings unknown_jet = testing::settings();
  unknown_jet.actuators[0].frame = "nothing";
  EXPECT_ANY_THROW(simulate_flight(model, unknown_jet));
}

}  // namespace
}  // namespace codesign::dynamics
