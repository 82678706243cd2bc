#include "bindings/bindings.hpp"

namespace py = pybind11;

namespace codesign {

void bind_dynamics(py::module_& m) { (void)m; }

}  // namespace codesign
