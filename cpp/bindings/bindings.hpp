#pragma once

#include <pybind11/pybind11.h>

// One function per group of bindings; conversion and docstrings only, no algorithms.
namespace codesign {

void bind_dynamics(
    pybind11::module_& m);               // submodule codesign._core.dynamics: models and algorithms
void bind_flight(pybind11::module_& m);  // the same submodule: box QP, flight
void bind_trim(pybind11::module_& m);    // the same submodule: hover
void bind_predictive(pybind11::module_& m);  // the same submodule: predictive control, paths
void bind_predictive_controller(pybind11::module_& m);  // after the flight settings
void bind_convex(pybind11::module_& m);   // the same submodule: distances of convex hulls
void bind_surface(pybind11::module_& m);  // submodule codesign._core.fem: closed surfaces
void bind_mesh(pybind11::module_& m);     // the same submodule: sizes, tetrahedra
void bind_static(pybind11::module_& m);   // the same submodule: elasticity, results
void bind_evaluate(
    pybind11::module_& m);  // codesign._core.evaluate: meshes, solves, flies in one call

void bind_interrupt(pybind11::module_& m);  // submodule codesign._core.interrupt: Ctrl-C

}  // namespace codesign
