#include "dynamics/standardized_turbine.hpp"

#include <algorithm>
#include <cmath>

namespace codesign::dynamics {

TurbineTerms turbine_terms(const StandardizedTurbine& t, const ThrustState& state) {
  const double T = (state.thrust - t.thrust_mean) / t.thrust_scale;
  const double D = state.thrust_rate / t.thrust_scale;
  TurbineTerms terms;
  terms.f = t.c + t.K_T * T + t.K_D * D + t.K_TD * T * D + t.K_TT * T * T + t.K_DD * D * D;
  terms.g = t.B + t.B_T * T + t.B_D * D + t.B_TD * T * D + t.B_TT * T * T + t.B_DD * D * D;
  terms.f_T = t.K_T + t.K_TD * D + 2.0 * t.K_TT * T;
  terms.f_D = t.K_D + t.K_TD * T + 2.0 * t.K_DD * D;
  terms.g_T = t.B_T + t.B_TD * D + 2.0 * t.B_TT * T;
  terms.g_D = t.B_D + t.B_TD * T + 2.0 * t.B_DD * D;
  return terms;
}

double throttle_variable(const StandardizedTurbine& turbine, double throttle) {
  const double u = (throttle - turbine.throttle_mean) / turbine.throttle_scale;
  return u + turbine.B_UU * u * u;
}

double throttle_of_variable(const StandardizedTurbine& turbine, double v) {
  // The root that goes through v = 0, in the form without cancellation.
  const double u = 2.0 * v / (1.0 + std::sqrt(std::max(1.0 + 4.0 * turbine.B_UU * v, 0.0)));
  return std::clamp(turbine.throttle_mean + turbine.throttle_scale * u, 0.0, turbine.throttle_max);
}

double steady_variable(const StandardizedTurbine& turbine, double thrust) {
  const TurbineTerms terms = turbine_terms(turbine, {thrust, 0.0});
  return -terms.f / terms.g;
}

double steady_variable_slope(const StandardizedTurbine& turbine, double thrust) {
  const TurbineTerms terms = turbine_terms(turbine, {thrust, 0.0});
  return (terms.f * terms.g_T - terms.f_T * terms.g) / (terms.g * terms.g * turbine.thrust_scale);
}

double thrust_acceleration(const StandardizedTurbine& turbine, const ThrustState& state, double v) {
  const TurbineTerms terms = turbine_terms(turbine, state);
  return turbine.thrust_scale * (terms.f + terms.g * v);
}

ThrustState advance(const StandardizedTurbine& turbine, const ThrustState& state, double throttle,
                    double step) {
  constexpr double kNode[4] = {0.0, 0.5, 0.5, 1.0};
  constexpr double kWeight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
  const double v = throttle_variable(turbine, throttle);
  ThrustState rate, sum;
  for (int i = 0; i < 4; ++i) {
    const ThrustState stage{state.thrust + kNode[i] * step * rate.thrust,
                            state.thrust_rate + kNode[i] * step * rate.thrust_rate};
    rate = {stage.thrust_rate, thrust_acceleration(turbine, stage, v)};
    sum.thrust += kWeight[i] * rate.thrust;
    sum.thrust_rate += kWeight[i] * rate.thrust_rate;
  }
  return {std::max(state.thrust + step * sum.thrust, 0.0),
          state.thrust_rate + step * sum.thrust_rate};
}

double throttle_for_rate(const StandardizedTurbine& turbine, const ThrustState& state,
                         double wanted_rate) {
  const TurbineTerms terms = turbine_terms(turbine, state);
  const double wanted = turbine.rate_gain * (wanted_rate - state.thrust_rate);
  return throttle_of_variable(turbine, (wanted / turbine.thrust_scale - terms.f) / terms.g);
}

}  // namespace codesign::dynamics
