#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "dynamics/flight/flight_log.hpp"
#include "dynamics/flight_settings.hpp"
#include "dynamics/model.hpp"
#include "dynamics/momentum_controller.hpp"
#include "dynamics/plant.hpp"

namespace codesign::dynamics {

// Flies the robot along the settings' trajectory and returns what happened. The model must have a
// floating base and exactly the joints of the settings, in that order (load_urdf with
// UrdfOptions::joints). A lost flight is a status of the log, not an exception.
// Throws std::invalid_argument if settings and model do not fit each other.
FlightLog simulate_flight(const Model& model, const FlightSettings& settings);

// A robot of the caller's own, another simulator say: moves the state by `duration` (s) under
// inputs held over it. Its masses, drag, friction and fuel are its own.
using OwnPlant = std::function<void(const PlantInputs& inputs, double duration, RobotState& state)>;

// The same with the controllers and jets of this flight around a plant of the caller's own, which
// may throw. Throws std::invalid_argument for the predictive controller: its servos are its
// plant's.
FlightLog simulate_flight(const Model& model, const FlightSettings& settings,
                          const OwnPlant& plant);

// The same flight once for every seed of its disturbances.
std::vector<FlightLog> simulate_flights(const Model& model, const FlightSettings& settings,
                                        const std::vector<std::uint64_t>& seeds);

// The momentum QPs of samples 0, every, 2 every, … of a flight, rebuilt from its log: to look into
// a flight, or to compare solvers on the problems that occur. Throws std::invalid_argument if the
// log is not of this model and these settings.
std::vector<MomentumQp> momentum_qps(const Model& model, const FlightSettings& settings,
                                     const FlightLog& log, int every);

}  // namespace codesign::dynamics
