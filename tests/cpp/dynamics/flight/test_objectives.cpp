#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <numbers>

#include "dynamics/flight/objectives.hpp"
#include "flying_robot.hpp"

namespace codesign::dynamics {
namespace {

TEST(Objectives, SpectralNormIsTheLargestSingularValue) {
  Eigen::MatrixXd X(7, 3);
  for (Eigen::Index i = 0; i < X.size(); ++i) X.data()[i] = std::sin(1.7 * static_cast<double>(i));
  EXPECT_NEAR(spectral_norm(X), X.jacobiSvd().singularValues()[0], 1e-13);
}

TEST(Objectives, ReshapedSeriesRunsSampleAfterSampleDownItsColumns) {
  History series(3, 2);
  series << 1, 2, 3, 4, 5, 6;
  Eigen::MatrixXd expected(3, 2);
  expected << 1, 4, 2, 5, 3, 6;
  EXPECT_EQ(reshaped_series(series), expected);
}

// Four samples with hand-made errors.
TEST(Objectives, FamiliesOfAHandMadeLog) {
  FlightSettings settings = testing::settings();
  FlightLog log = make_flight_log(4, 6, 4);
  log.samples = 4;
  log.thrust.setConstant(10.0);
  log.thrust(0, 0) = 18.0;
  log.momentum_error.setZero();
  log.momentum_error(0, 0) = 3.0;   // E_l: one entry
  log.momentum_error(1, 4) = -4.0;  // E_w: two entries of opposite sign
  log.momentum_error(2, 4) = 4.0;
  log.velocity.setZero();
  log.joint_velocity_command.setZero();
  log.velocity(1, 6 + 2) = 0.2;                // left, measured
  log.joint_velocity_command(3, 3 + 1) = 0.1;  // right, commanded
  compute_objectives(settings, log);

  const double degrees = 180.0 / std::numbers::pi;
  EXPECT_NEAR(log.script.thrust, 42.0, 1e-12);
  EXPECT_NEAR(log.script_parts.linear_momentum, 3.0, 1e-12);
  EXPECT_NEAR(log.script_parts.angular_momentum, std::sqrt(32.0), 1e-12);
  EXPECT_NEAR(log.script.momentum, 3.0 + std::sqrt(32.0), 1e-12);
  EXPECT_NEAR(log.script_parts.joint_velocity[0], 0.2 * degrees, 1e-12);
  EXPECT_NEAR(log.script.joint_velocity, (0.2 + 2.0 * 0.1) * degrees, 1e-12);
  EXPECT_NEAR(log.rms.momentum, (3.0 + std::sqrt(32.0)) / 2.0, 1e-12);
  EXPECT_NEAR(log.rms.joint_velocity, (0.2 + 2.0 * 0.1) / 2.0, 1e-12);
  EXPECT_NEAR(log.paper.momentum, 9.0, 1e-12);  // the angular errors cancel
  EXPECT_NEAR(log.paper.joint_velocity, 0.04 + 2.0 * 0.01, 1e-12);
}

}  // namespace
}  // namespace codesign::dynamics
