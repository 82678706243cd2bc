#pragma once

#include <pybind11/pybind11.h>

namespace codesign {

void bind_flight_settings(pybind11::module_& m);  // FlightSettings and its parts

}  // namespace codesign
