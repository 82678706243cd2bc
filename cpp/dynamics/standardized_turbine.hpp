#pragma once

#include "dynamics/jet.hpp"

namespace codesign::dynamics {

// Second-order jet identified in standardized variables. With T̄ = (T − thrust_mean)/thrust_scale,
// D̄ = Ṫ/thrust_scale and Ū = (U − throttle_mean)/throttle_scale, throttle U [%]:
//   T̈ = thrust_scale (f(T̄, D̄) + g(T̄, D̄) v),   v = Ū + B_UU Ū²,
//   f = c + K_T T̄ + K_D D̄ + K_TD T̄ D̄ + K_TT T̄² + K_DD D̄²,
//   g = B + B_T T̄ + B_D D̄ + B_TD T̄ D̄ + B_TT T̄² + B_DD D̄².
struct StandardizedTurbine {
  double thrust_mean = 0.0, thrust_scale = 1.0;      // [N]
  double throttle_mean = 0.0, throttle_scale = 1.0;  // [%]
  double c = 0.0, K_T = 0.0, K_D = 0.0, K_TD = 0.0, K_TT = 0.0, K_DD = 0.0;
  double B = 1.0, B_T = 0.0, B_D = 0.0, B_TD = 0.0, B_TT = 0.0, B_DD = 0.0;
  double B_UU = 0.0;
  double throttle_max = 100.0;  // [%]; the least is 0
  double rate_gain = 50.0;      // of the feedback linearization that follows a thrust rate [1/s]
};

// f, g and their derivatives with respect to T̄ and D̄ at a state.
struct TurbineTerms {
  double f, g, f_T, f_D, g_T, g_D;
};
TurbineTerms turbine_terms(const StandardizedTurbine& turbine, const ThrustState& state);

// v of a throttle [%], and the throttle of v, clipped to 0 … throttle_max.
double throttle_variable(const StandardizedTurbine& turbine, double throttle);
double throttle_of_variable(const StandardizedTurbine& turbine, double v);

// v that holds a thrust [N] steady; its derivative with respect to the thrust [1/N].
double steady_variable(const StandardizedTurbine& turbine, double thrust);
double steady_variable_slope(const StandardizedTurbine& turbine, double thrust);

// T̈ [N/s²].
double thrust_acceleration(const StandardizedTurbine& turbine, const ThrustState& state, double v);

// State after `step` seconds of constant throttle, by one classical Runge-Kutta step; a thrust does
// not fall below zero.
ThrustState advance(const StandardizedTurbine& turbine, const ThrustState& state, double throttle,
                    double step);

// Throttle that makes T̈ = −rate_gain (Ṫ − wanted_rate), as far as its range allows.
double throttle_for_rate(const StandardizedTurbine& turbine, const ThrustState& state,
                         double wanted_rate);

}  // namespace codesign::dynamics
