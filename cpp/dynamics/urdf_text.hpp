#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace codesign::dynamics {

inline constexpr std::size_t kMaxUrdfBytes = std::size_t{64} << 20U;

// A URDF reduced to what rigid-body dynamics needs, rewritten so that any parser reads it alike:
// only <link> with <inertial>, and <joint> with <origin>, <parent>, <child>, <axis>, <limit> and
// <mimic>; every number has been parsed, is finite and is written back exactly.
struct UrdfText {
  std::string xml;
  std::vector<std::string> links, joints;  // names, in the order of the text
};

// Throws UrdfError naming line or element: text that is not well-formed XML, too large, not a
// robot; elements given twice or without name; numbers that are none, not finite or absurd.
UrdfText reduce_urdf(std::string_view text);

}  // namespace codesign::dynamics
