#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/motion_filter.hpp"

namespace codesign::dynamics {
namespace {

using Eigen::Vector3d;

TEST(MotionFilter, RestsAtItsFirstInput) {
  MotionFilter filter(1.5, 0.008);
  const Vector3d input(1.0, -2.0, 0.5);
  for (int k = 0; k < 100; ++k) {
    const MotionFilter::Output& out = filter.update(input);
    EXPECT_LT((out.value - input).norm(), 1e-12);
    EXPECT_LT(out.velocity.norm(), 1e-12);
    EXPECT_LT(out.acceleration.norm(), 1e-10);
  }
}

TEST(MotionFilter, StepReachesNinetyPercentNearItsTimeAndSettlesByOneAndAHalf) {
  const double time = 1.5, step = 0.008;
  MotionFilter filter(time, step);
  filter.update(Vector3d::Zero());
  double reached = 0.0, worst_after = 0.0;
  for (int k = 1; k * step < 2.5 * time; ++k) {
    const double value = filter.update(Vector3d::Ones()).value.x();
    if (reached == 0.0 && value >= 0.9) reached = k * step;
    if (k * step > 1.5 * time) worst_after = std::max(worst_after, std::abs(value - 1.0));
  }
  EXPECT_NEAR(reached, time, 0.35 * time);
  EXPECT_LT(worst_after, 0.02);
}

// Tustin's rule is the trapezoidal rule: velocity integrates to value, acceleration to velocity.
TEST(MotionFilter, OutputsAreTrapezoidalIntegralsOfEachOther) {
  const double step = 0.008;
  MotionFilter filter(0.05, step);
  MotionFilter::Output last = filter.update(Vector3d::Zero());
  for (int k = 1; k < 500; ++k) {
    const Vector3d input(std::sin(0.1 * k), k < 200 ? 1.0 : -1.0, 0.01 * k);
    const MotionFilter::Output now = filter.update(input);
    EXPECT_LT((now.value - last.value - 0.5 * step * (now.velocity + last.velocity)).norm(), 1e-12);
    EXPECT_LT(
        (now.velocity - last.velocity - 0.5 * step * (now.acceleration + last.acceleration)).norm(),
        1e-9);
    last = now;
  }
}

TEST(MotionFilter, FollowsTheContinuousTransferFunctionAtLowFrequency) {
  const double time = 1.5, step = 0.008, omega = 1.0;
  MotionFilter filter(time, step);
  const double a = 150.765868956161 / std::pow(time, 3), b = 84.9812819469538 / std::pow(time, 2),
               g = 15.9669610709384 / time;
  const double real = a - g * omega * omega, imaginary = b * omega - omega * omega * omega;
  const double gain = a / std::hypot(real, imaginary), lag = std::atan2(imaginary, real);
  double worst = 0.0;
  for (int k = 0; k < 5000; ++k) {
    const double t = k * step;
    const double value = filter.update(Vector3d::Constant(std::sin(omega * t))).value.y();
    if (t > 20.0) worst = std::max(worst, std::abs(value - gain * std::sin(omega * t - lag)));
  }
  EXPECT_LT(worst, 2e-5);  // of the order (omega step)²
}

}  // namespace
}  // namespace codesign::dynamics
