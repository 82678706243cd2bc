#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <limits>
#include <string_view>

#include "dynamics/urdf/urdf_text.hpp"

// Which elements of a URDF are read, and what the numbers in them must be.
namespace codesign::dynamics {

inline constexpr double kLargestNumber =
    1e9;  // a length, an angle, a mass, an inertia, in SI units
inline constexpr double kAnyNumber = std::numeric_limits<double>::max();

using Names = std::initializer_list<std::string_view>;
inline constexpr std::array kShapes =
    std::to_array<std::string_view>({"box", "cylinder", "capsule", "sphere", "mesh"});
inline constexpr std::string_view kShapeWords = "box, cylinder, capsule, sphere or mesh";

// The numbers of an attribute.
struct NumberRule {
  std::string_view element, attribute;
  int count = 1;
  double largest = kLargestNumber;
  bool required = false;
  bool not_negative = false;
  bool one_will_do = false;
};
inline constexpr std::array kNumbers = {
    NumberRule{"origin", "xyz", 3},
    NumberRule{"origin", "rpy", 3},
    NumberRule{"origin", "quat_xyzw", 4},
    NumberRule{"axis", "xyz", 3},
    NumberRule{.element = "mass", .attribute = "value", .required = true},
    NumberRule{.element = "inertia", .attribute = "ixx", .required = true},
    NumberRule{.element = "inertia", .attribute = "ixy", .required = true},
    NumberRule{.element = "inertia", .attribute = "ixz", .required = true},
    NumberRule{.element = "inertia", .attribute = "iyy", .required = true},
    NumberRule{.element = "inertia", .attribute = "iyz", .required = true},
    NumberRule{.element = "inertia", .attribute = "izz", .required = true},
    NumberRule{.element = "limit", .attribute = "lower", .largest = kAnyNumber},
    NumberRule{.element = "limit", .attribute = "upper", .largest = kAnyNumber},
    NumberRule{
        .element = "limit", .attribute = "velocity", .largest = kAnyNumber, .required = true},
    NumberRule{.element = "limit", .attribute = "effort", .largest = kAnyNumber, .required = true},
    NumberRule{.element = "mimic", .attribute = "multiplier", .largest = kAnyNumber},
    NumberRule{.element = "mimic", .attribute = "offset", .largest = kAnyNumber},
    NumberRule{
        .element = "box", .attribute = "size", .count = 3, .required = true, .not_negative = true},
    NumberRule{"cylinder", "radius", 1, kLargestNumber, true, true},
    NumberRule{"cylinder", "length", 1, kLargestNumber, true, true},
    NumberRule{"capsule", "radius", 1, kLargestNumber, true, true},
    NumberRule{"capsule", "length", 1, kLargestNumber, true, true},
    NumberRule{"sphere", "radius", 1, kLargestNumber, true, true},
    NumberRule{.element = "mesh", .attribute = "scale", .count = 3, .one_will_do = true},
    NumberRule{.element = "color", .attribute = "rgba", .count = 4}};

inline constexpr std::array<std::string_view, 6> kJointTypes = {
    "fixed", "revolute", "continuous", "prismatic", "floating", "planar"};

// Whether a list holds a name.
inline bool one_of(std::string_view name, Names names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Whether joints of a type need a range.
inline bool needs_limits(std::string_view type) { return one_of(type, {"revolute", "prismatic"}); }

// Whether joints of a type move along or about an axis.
inline bool has_axis(std::string_view type) { return needs_limits(type) || type == "continuous"; }

// Whether an element of a link is a shape of it.
inline bool is_shape(std::string_view element) { return one_of(element, {"visual", "collision"}); }

// Whether an element below another is read; the rest is ignored.
inline bool is_read(std::string_view parent, std::string_view element, UrdfScope scope) {
  if (parent == "robot") return one_of(element, {"link", "joint"});
  if (parent == "link") {
    return element == "inertial" || (scope == UrdfScope::kShapes && is_shape(element));
  }
  if (parent == "inertial") return one_of(element, {"origin", "mass", "inertia"});
  if (parent == "joint") {
    return one_of(element, {"origin", "parent", "child", "axis", "limit", "mimic"});
  }
  if (is_shape(parent)) return one_of(element, {"origin", "geometry", "material"});
  if (parent == "geometry")
    return std::find(kShapes.begin(), kShapes.end(), element) != kShapes.end();
  return parent == "material" && element == "color";
}

}  // namespace codesign::dynamics
