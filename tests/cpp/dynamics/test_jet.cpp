#include <gtest/gtest.h>

#include "dynamics/jet.hpp"

namespace codesign::dynamics {
namespace {

// P220 of the published models.
Turbine p220() {
  Turbine t;
  t.K_T = 0.237755, t.K_TT = -0.012799, t.K_D = -0.860374, t.K_DD = 0.023606, t.K_TD = 0.008599;
  t.B_U = 1.139026, t.B_T = 0.019914, t.B_D = -0.050257, t.B_UU = 0.000302, t.c = -0.692913;
  return t;
}

double acceleration(const Turbine& t, const TurbineState& s, double U) {
  return turbine_drift(t, s) + turbine_gain(t, s) * (U + t.B_UU * U * U);
}

TEST(Turbine, ThrottleLinearisesTheDynamicsWithinItsRange) {
  const Turbine t = p220();
  for (const TurbineState s : {TurbineState{175.0, 0.0}, {100.0, 20.0}, {200.0, -5.0}}) {
    const double wanted = 3.0, gain = 5.0;
    const double U = throttle_for_rate(t, s, wanted, gain);
    ASSERT_GT(U, 0.0);
    ASSERT_LT(U, 120.0);
    EXPECT_NEAR(acceleration(t, s, U), -gain * (s.thrust_rate - wanted), 1e-10);
  }
}

TEST(Turbine, ThrottleStaysInItsRange) {
  const Turbine t = p220();
  EXPECT_NEAR(throttle_for_rate(t, {175.0, 0.0}, 1e6, 50.0), 120.0, 1e-9);
  EXPECT_NEAR(throttle_for_rate(t, {175.0, 0.0}, -1e6, 50.0), 0.0, 1e-9);
}

TEST(Turbine, LinearThrottleNeedsNoRoot) {
  Turbine t = p220();
  t.B_UU = 0.0;
  const TurbineState s{150.0, 1.0};
  const double U = throttle_for_rate(t, s, 2.0, 10.0);
  EXPECT_NEAR(acceleration(t, s, U), 10.0, 1e-10);
}

TEST(Turbine, AdvanceIsExactForConstantAcceleration) {
  Turbine t;
  t.c = 4.0;
  TurbineState s{10.0, 1.0};
  for (int k = 0; k < 100; ++k) s = advance(t, s, 0.0, 0.01);
  EXPECT_NEAR(s.thrust, 10.0 + 1.0 + 0.5 * 4.0, 1e-12);
  EXPECT_NEAR(s.thrust_rate, 5.0, 1e-12);
}

}  // namespace
}  // namespace codesign::dynamics
