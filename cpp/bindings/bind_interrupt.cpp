#include <pybind11/stl/filesystem.h>

#include "bindings/bindings.hpp"
#include "bindings/interrupt_guard.hpp"
#include "interrupt.hpp"

namespace py = pybind11;
using py::literals::operator""_a;

namespace codesign {

namespace {

unsigned long main_thread = 0;
std::atomic<bool> stop_others{false};

// Python's main thread runs the signal handlers that are due (an exception of theirs stays set and
// is the one that comes out of the call); other threads look at the switch. They must not wait for
// the interpreter's lock, which the main thread may hold for long.
bool stop_wanted() {
  if (PyThread_get_thread_ident() != main_thread) return stop_others;
  const py::gil_scoped_acquire lock;
  return PyErr_CheckSignals() != 0;
}

}  // namespace

void bind_interrupt(py::module_& m) {
  main_thread =
      py::module_::import("threading").attr("main_thread")().attr("ident").cast<unsigned long>();
  interrupt_query = &stop_wanted;
  m.def(
      "stop_threads", [](bool stop) { stop_others = stop; }, "stop"_a,
      "Has computations on other threads than the main one end with KeyboardInterrupt.");
  m.def("start_guard", &start_interrupt_guard, "descriptor"_a, "grace"_a,
        "Ends the process with exit code 130 if an interrupt read from the descriptor is not "
        "acknowledged within `grace` seconds; a zero byte ends the watch.");
  m.def("acknowledge", &acknowledge_interrupts, "Python has taken note of the interrupts so far.");
  m.def("add_temporary", &add_temporary, "path"_a,
        "A file or folder to be removed if the guard ends the process.");
  m.def("remove_temporary", &remove_temporary, "path"_a);
}

}  // namespace codesign
