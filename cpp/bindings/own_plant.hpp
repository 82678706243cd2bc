#pragma once

#include <pybind11/functional.h>
#include <pybind11/pybind11.h>

#include <functional>

#include "dynamics/flight/flight.hpp"

namespace codesign {

// A plant as Python writes it: returns the state after the period.
using PythonPlant = std::function<dynamics::RobotState(
    const dynamics::PlantInputs& inputs, double duration, const dynamics::RobotState& state)>;

// The same as flights call it; checks the sizes of what comes back.
dynamics::OwnPlant own_plant(PythonPlant plant);

// RobotState, PlantInputs.
void bind_own_plant(pybind11::module_& m);

}  // namespace codesign
