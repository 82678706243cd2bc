#pragma once

#include "dynamics/flight/flight_log.hpp"
#include "dynamics/flight/flight_start.hpp"
#include "dynamics/flight_settings.hpp"
#include "dynamics/model.hpp"

namespace codesign::dynamics {

// A flight under the predictive controller: the full robot with position servos and its jets, a
// sample of the log at every solve. Does not check the settings; simulate_flight does, and adds the
// summary.
FlightLog simulate_predictive_flight(const Model& model, const FlightSettings& settings,
                                     const FlightStart& start);

}  // namespace codesign::dynamics
