#pragma once

#include "dynamics/flight_log.hpp"
#include "dynamics/flight_settings.hpp"
#include "dynamics/model.hpp"

namespace codesign::dynamics {

// Flies the robot along the settings' trajectory and returns what happened. The model must have a
// floating base and exactly the joints of the settings, in that order (load_urdf with
// UrdfOptions::joints). A lost flight is a status of the log, not an exception.
// Throws std::invalid_argument if settings and model do not fit each other.
FlightLog simulate_flight(const Model& model, const FlightSettings& settings);

}  // namespace codesign::dynamics
