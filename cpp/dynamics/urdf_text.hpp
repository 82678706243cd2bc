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
  struct Joint {
    std::string name, parent, child;
  };
  std::string xml;
  std::vector<std::string> links;  // names; both lists in the order of the text
  std::vector<Joint> joints;
};

// Throws UrdfError naming line or element: text that is not well-formed XML, too large, not a
// robot; elements given twice or without name; numbers that are none, not finite or absurd; links
// and joints that do not form one tree.
UrdfText reduce_urdf(std::string_view text);

}  // namespace codesign::dynamics
