#pragma once

#include "dynamics/flight_settings.hpp"
#include "dynamics/robot_terms.hpp"

// How a flight begins.
namespace codesign::dynamics {

// The state that a flight begins in.
struct FlightStart {
  RobotState state;
  Eigen::VectorXd thrusts;  // (jets) [N]
  bool hovers = true;       // false: asked to start in a hover, and there is none
};

// The settings with what they leave to the model: its joint ranges. Throws std::invalid_argument if
// settings and model do not fit each other.
FlightSettings fitted(const Model& model, const FlightSettings& settings);

// The initial state of fitted settings, or the hover nearest to it.
FlightStart flight_start(const Model& model, const FlightSettings& settings);

// Joint ranges the controller keeps to: the settings' limits times their scale.
JointRanges controlled_ranges(const FlightSettings& settings);

}  // namespace codesign::dynamics
