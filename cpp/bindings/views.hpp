#pragma once

#include <pybind11/numpy.h>

#include <vector>

namespace codesign {

// Read-only NumPy view of values that `owner` keeps alive.
inline pybind11::array view(const std::vector<int>& values, pybind11::handle owner) {
  pybind11::array_t<int> array(static_cast<pybind11::ssize_t>(values.size()), values.data(), owner);
  array.attr("setflags")(pybind11::arg("write") = false);
  return array;
}

}  // namespace codesign
