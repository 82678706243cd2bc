#pragma once

#include <string>

namespace codesign::dynamics {

// Second-order thrust dynamics of a small jet engine, thrust T [N], throttle U [%]:
//   T̈ = f(T, Ṫ) + g(T, Ṫ) (U + B_UU U²),
//   f = K_T T + K_TT T² + K_D Ṫ + K_DD Ṫ² + K_TD T Ṫ + c,   g = B_U + B_T T + B_D Ṫ.
// Source of the form and of the identified coefficients: L'Erario et al., "Modeling, Identification
// and Control of Model Jet Engines for Jet Powered Robotics", RA-L 2020, and the authors' models.
struct Turbine {
  double K_T = 0.0, K_TT = 0.0, K_D = 0.0, K_DD = 0.0, K_TD = 0.0;
  double B_U = 0.0, B_T = 0.0, B_D = 0.0, B_UU = 0.0;
  double c = 0.0;
  double throttle_max = 120.0;  // [%]; the least is 0
  double rate_gain = 50.0;      // of the feedback linearization that follows a thrust rate [1/s]
};

// State of a jet whose thrust has dynamics of second order.
struct ThrustState {
  double thrust = 0.0;       // [N]
  double thrust_rate = 0.0;  // [N/s]
};

// f and g above.
double turbine_drift(const Turbine& turbine, const ThrustState& state);
double turbine_gain(const Turbine& turbine, const ThrustState& state);

// State after `step` seconds of constant throttle: T += h Ṫ + ½h² T̈, Ṫ += h T̈.
ThrustState advance(const Turbine& turbine, const ThrustState& state, double throttle, double step);

// Throttle that makes T̈ = −rate_gain (Ṫ − wanted_rate), as far as its range allows (feedback
// linearization).
double throttle_for_rate(const Turbine& turbine, const ThrustState& state, double wanted_rate);

}  // namespace codesign::dynamics
