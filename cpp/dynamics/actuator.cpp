#include "dynamics/actuator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace codesign::dynamics {

namespace {

// One overload per kind of dynamics.
struct Command {
  const Actuator& actuator;
  const ThrustState& state;
  double wanted_rate;

  double operator()(const RateIntegrator&) const { return wanted_rate; }
  double operator()(const FirstOrderLag& lag) const {
    return std::clamp(state.thrust + lag.time * wanted_rate, actuator.thrust_min,
                      actuator.thrust_max);
  }
  double operator()(const Turbine& turbine) const {
    return throttle_for_rate(turbine, state, wanted_rate);
  }
  double operator()(const StandardizedTurbine& turbine) const {
    return throttle_for_rate(turbine, state, wanted_rate);
  }
};

struct Advance {
  const ThrustState& state;
  double command, step;

  ThrustState operator()(const RateIntegrator&) const {
    return {state.thrust + step * command, command};
  }
  ThrustState operator()(const FirstOrderLag& lag) const {
    const double thrust = command + (state.thrust - command) * std::exp(-step / lag.time);
    return {thrust, (command - thrust) / lag.time};
  }
  ThrustState operator()(const Turbine& turbine) const {
    return dynamics::advance(turbine, state, command, step);
  }
  ThrustState operator()(const StandardizedTurbine& turbine) const {
    return dynamics::advance(turbine, state, command, step);
  }
};

}  // namespace

double command_for_rate(const Actuator& actuator, const ThrustState& state, double wanted_rate) {
  return std::visit(Command{actuator, state, wanted_rate}, actuator.dynamics);
}

ThrustState advance(const Actuator& actuator, const ThrustState& state, double command,
                    double step) {
  return std::visit(Advance{state, command, step}, actuator.dynamics);
}

ThrustState thrust_state_rate(const Actuator& actuator, const ThrustState& state, double command) {
  const auto* turbine = std::get_if<StandardizedTurbine>(&actuator.dynamics);
  if (turbine == nullptr) {
    throw std::invalid_argument("actuator \"" + actuator.frame + "\" has no standardized turbine");
  }
  return {state.thrust_rate,
          thrust_acceleration(*turbine, state, throttle_variable(*turbine, command))};
}

}  // namespace codesign::dynamics
