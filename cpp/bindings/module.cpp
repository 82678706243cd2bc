#include <pybind11/pybind11.h>

#include "bindings/bindings.hpp"
#include "errors.hpp"
#include "interrupt.hpp"
#include "model_error.hpp"

namespace py = pybind11;

PYBIND11_MODULE(_core, m) {
  m.doc() = "Compiled core of codesign: rigid-body dynamics, flight, finite elements.";

  // The classes live in codesign.errors; here the C++ exceptions are mapped onto them by name.
  // The reference is kept for the life of the process: a static owner would outlive the
  // interpreter.
  static const py::handle errors = py::module_::import("codesign.errors").release();
  py::register_exception_translator([](std::exception_ptr p) {
    const auto raise = [](const char* name, const std::exception& e) {
      PyErr_SetString(errors.attr(name).ptr(), e.what());
    };
    try {
      if (p) std::rethrow_exception(p);
    } catch (const codesign::UnknownNameError& e) {
      raise("UnknownNameError", e);
    } catch (const codesign::UrdfError& e) {
      raise("UrdfError", e);
    } catch (const codesign::MeshLimitError& e) {
      raise("MeshLimitError", e);
    } catch (const codesign::MeshError& e) {
      raise("MeshError", e);
    } catch (const codesign::MemoryLimitError& e) {
      raise("MemoryLimitError", e);
    } catch (const codesign::ModelError& e) {
      raise("ModelError", e);
    } catch (const codesign::SolverError& e) {
      raise("SolverError", e);
    } catch (const codesign::Error& e) {
      raise("CodesignError", e);
    } catch (const codesign::Interrupted&) {  // a signal handler's own exception is set already
      if (PyErr_Occurred() == nullptr) PyErr_SetNone(PyExc_KeyboardInterrupt);
    }
  });

  py::module_ dynamics = m.def_submodule("dynamics", "Rigid-body dynamics, box QP and flight.");
  codesign::bind_dynamics(dynamics);
  codesign::bind_predictive(dynamics);
  codesign::bind_flight(dynamics);
  codesign::bind_trim(dynamics);
  codesign::bind_predictive_controller(dynamics);
  codesign::bind_convex(dynamics);
  py::module_ fem = m.def_submodule("fem", "Surfaces, tetrahedra and linear elasticity.");
  codesign::bind_surface(fem);
  codesign::bind_mesh(fem);
  codesign::bind_static(fem);
  codesign::bind_evaluate(m);
  py::module_ interrupt = m.def_submodule("interrupt", "What Ctrl-C does to long computations.");
  codesign::bind_interrupt(interrupt);
}
