#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>

#include "dynamics/jet.hpp"
#include "dynamics/standardized_turbine.hpp"

namespace codesign::dynamics {

// Thrust follows the commanded rate; the command is the rate [N/s].
struct RateIntegrator {};

// A propeller behind its speed controller: Ṫ = (command − T) / time; the command is a thrust [N].
struct FirstOrderLag {
  double time = 0.05;  // [s]
};

using ThrustDynamics = std::variant<RateIntegrator, FirstOrderLag, Turbine, StandardizedTurbine>;

// What pushes the robot along a line fixed in a frame: a jet, a propeller. The wrench per newton of
// thrust is the unit force along the axis and the moment `reaction` about it: the drag torque of a
// propeller, positive where it turns the robot counter-clockwise about the axis.
struct Actuator {
  std::string frame;
  Eigen::Vector3d axis = -Eigen::Vector3d::UnitZ();  // unit vector in the frame
  double reaction = 0.0;                             // [Nm/N]
  double thrust_min = 0.0, thrust_max = 1.0;         // [N]
  double thrust_rate = 1.0;                          // largest [N/s]
  ThrustDynamics dynamics = RateIntegrator{};
};

// Fuel of one jet: idle + per_newton · thrust [kg/s].
struct FuelRate {
  double idle = 0.0;        // [kg/s]
  double per_newton = 0.0;  // [kg/s/N]
};

// The command that makes the thrust change at `wanted_rate` [N/s], as far as the range allows.
double command_for_rate(const Actuator& actuator, const ThrustState& state, double wanted_rate);

// State after `step` seconds of constant command.
ThrustState advance(const Actuator& actuator, const ThrustState& state, double command,
                    double step);

// (Ṫ, T̈) under a command, of dynamics that are a differential equation of their thrust and rate;
// std::invalid_argument for those that are not.
ThrustState thrust_state_rate(const Actuator& actuator, const ThrustState& state, double command);

}  // namespace codesign::dynamics
