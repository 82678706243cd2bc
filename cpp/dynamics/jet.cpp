#include "dynamics/jet.hpp"

#include <algorithm>
#include <cmath>

namespace codesign::dynamics {

namespace {

// The input the dynamics are affine in.
double throttle_effect(const Turbine& turbine, double throttle) {
  return throttle + turbine.B_UU * throttle * throttle;
}

}  // namespace

double turbine_drift(const Turbine& turbine, const ThrustState& state) {
  const double T = state.thrust;
  const double D = state.thrust_rate;
  return turbine.K_T * T + turbine.K_TT * T * T + turbine.K_D * D + turbine.K_DD * D * D +
         turbine.K_TD * T * D + turbine.c;
}

double turbine_gain(const Turbine& turbine, const ThrustState& state) {
  return turbine.B_U + turbine.B_T * state.thrust + turbine.B_D * state.thrust_rate;
}

ThrustState advance(const Turbine& turbine, const ThrustState& state, double throttle,
                    double step) {
  const double acceleration = turbine_drift(turbine, state) +
                              turbine_gain(turbine, state) * throttle_effect(turbine, throttle);
  return {state.thrust + step * state.thrust_rate + 0.5 * step * step * acceleration,
          state.thrust_rate + step * acceleration};
}

double throttle_for_rate(const Turbine& turbine, const ThrustState& state, double wanted_rate) {
  const double wanted =
      -(turbine.rate_gain * (state.thrust_rate - wanted_rate) + turbine_drift(turbine, state)) /
      turbine_gain(turbine, state);
  const double most = throttle_effect(turbine, turbine.throttle_max);
  const double effect = std::clamp(wanted, std::min(0.0, most), std::max(0.0, most));
  if (turbine.B_UU == 0.0) return effect;
  return (-1.0 + std::sqrt(std::max(1.0 + 4.0 * turbine.B_UU * effect, 0.0))) /
         (2.0 * turbine.B_UU);
}

}  // namespace codesign::dynamics
