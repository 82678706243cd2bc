#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

// Settings structs as Python classes: made by keywords, copied, pickled and shown.
namespace codesign {

// Names and values of a settings object's attributes.
inline pybind11::dict attributes(const pybind11::object& self) {
  pybind11::dict result;
  const pybind11::object type = pybind11::type::of(self);
  for (const auto& [name, entry] : type.attr("__dict__").cast<pybind11::dict>()) {
    if (pybind11::hasattr(entry, "fset") && !entry.attr("fset").is_none()) {
      result[name] = self.attr(name);
    }
  }
  return result;
}

// Every key must be an attribute; an unknown one is a TypeError.
template <typename Settings>
std::unique_ptr<Settings> from_attributes(const pybind11::dict& values) {
  auto result = std::make_unique<Settings>();
  const pybind11::object self =
      pybind11::cast(result.get(), pybind11::return_value_policy::reference);
  for (const auto& [name, value] : values) {
    if (!pybind11::hasattr(self, name)) {
      throw pybind11::type_error(
          std::string(pybind11::str(pybind11::type::of(self).attr("__name__"))) +
          " has no attribute '" + std::string(pybind11::str(name)) + "'");
    }
    pybind11::setattr(self, name, value);
  }
  return result;
}

// Constructor by keywords, copies, pickling and text, from the attributes bound afterwards.
template <typename Settings>
void bind_keywords(pybind11::class_<Settings>& settings) {
  settings
      .def(pybind11::init(
          [](const pybind11::kwargs& values) { return from_attributes<Settings>(values); }))
      .def("__copy__", [](const Settings& self) { return Settings(self); })
      .def("__deepcopy__",
           [](const Settings& self, const pybind11::dict&) { return Settings(self); })
      .def(pybind11::pickle(
          [](const pybind11::object& self) { return attributes(self); },
          [](const pybind11::dict& state) { return from_attributes<Settings>(state); }))
      .def("__repr__", [](const pybind11::object& self) {
        std::string text = pybind11::str(pybind11::type::of(self).attr("__name__"));
        const char* separator = "(";
        for (const auto& [name, value] : attributes(self)) {
          text += separator + std::string(pybind11::str(name)) + "=" +
                  std::string(pybind11::repr(value));
          separator = ", ";
        }
        return text + ")";
      });
}

}  // namespace codesign
