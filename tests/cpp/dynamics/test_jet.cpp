#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/actuator.hpp"

namespace codesign::dynamics {
namespace {

// P220 of the published models.
Turbine p220() {
  Turbine t;
  t.K_T = 0.237755, t.K_TT = -0.012799, t.K_D = -0.860374, t.K_DD = 0.023606, t.K_TD = 0.008599;
  t.B_U = 1.139026, t.B_T = 0.019914, t.B_D = -0.050257, t.B_UU = 0.000302, t.c = -0.692913;
  return t;
}

double acceleration(const Turbine& t, const ThrustState& s, double U) {
  return turbine_drift(t, s) + turbine_gain(t, s) * (U + t.B_UU * U * U);
}

TEST(Turbine, ThrottleLinearizesTheDynamicsWithinItsRange) {
  Turbine t = p220();
  t.rate_gain = 5.0;
  for (const ThrustState s : {ThrustState{175.0, 0.0}, {100.0, 20.0}, {200.0, -5.0}}) {
    const double wanted = 3.0, gain = t.rate_gain;
    const double U = throttle_for_rate(t, s, wanted);
    ASSERT_GT(U, 0.0);
    ASSERT_LT(U, 120.0);
    EXPECT_NEAR(acceleration(t, s, U), -gain * (s.thrust_rate - wanted), 1e-10);
  }
}

TEST(Turbine, ThrottleStaysInItsRange) {
  const Turbine t = p220();
  EXPECT_NEAR(throttle_for_rate(t, {175.0, 0.0}, 1e6), 120.0, 1e-9);
  EXPECT_NEAR(throttle_for_rate(t, {175.0, 0.0}, -1e6), 0.0, 1e-9);
}

TEST(Turbine, LinearThrottleNeedsNoRoot) {
  Turbine t = p220();
  t.B_UU = 0.0;
  t.rate_gain = 10.0;
  const ThrustState s{150.0, 1.0};
  const double U = throttle_for_rate(t, s, 2.0);
  EXPECT_NEAR(acceleration(t, s, U), 10.0, 1e-10);
}

TEST(Turbine, AdvanceIsExactForConstantAcceleration) {
  Turbine t;
  t.c = 4.0;
  ThrustState s{10.0, 1.0};
  for (int k = 0; k < 100; ++k) s = advance(t, s, 0.0, 0.01);
  EXPECT_NEAR(s.thrust, 10.0 + 1.0 + 0.5 * 4.0, 1e-12);
  EXPECT_NEAR(s.thrust_rate, 5.0, 1e-12);
}

TEST(Actuator, IntegratorTakesTheRateAsItsCommand) {
  const Actuator jet;
  const ThrustState s{0.3, 0.0};
  EXPECT_EQ(command_for_rate(jet, s, 0.7), 0.7);
  EXPECT_EQ(advance(jet, s, 0.7, 0.1).thrust, 0.3 + 0.1 * 0.7);
}

TEST(Actuator, PropellerFollowsTheWantedRateAndThenItsOwnLag) {
  Actuator propeller;
  propeller.thrust_max = 20.0;
  propeller.dynamics = FirstOrderLag{0.05};
  const ThrustState s{8.0, 0.0};
  const double command = command_for_rate(propeller, s, 40.0);
  EXPECT_DOUBLE_EQ(command, 8.0 + 0.05 * 40.0);
  EXPECT_NEAR((advance(propeller, s, command, 1e-6).thrust - 8.0) / 1e-6, 40.0, 1e-3);
  // Under a held command: T(t) = c + (T0 - c) exp(-t / time), whatever the steps.
  ThrustState stepped = s;
  for (int k = 0; k < 30; ++k) stepped = advance(propeller, stepped, command, 0.004);
  EXPECT_NEAR(stepped.thrust, command + (8.0 - command) * std::exp(-0.12 / 0.05), 1e-12);
  EXPECT_DOUBLE_EQ(command_for_rate(propeller, s, 1e4), 20.0);
  EXPECT_DOUBLE_EQ(command_for_rate(propeller, s, -1e4), 0.0);
}

}  // namespace
}  // namespace codesign::dynamics
