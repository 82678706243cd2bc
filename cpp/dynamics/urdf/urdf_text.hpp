#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/urdf/xml_reader.hpp"

namespace codesign::dynamics {

inline constexpr std::size_t kMaxUrdfBytes = std::size_t{64} << 20U;

// What of a URDF is judged: links, joints and inertias, or the shapes and colors of visuals and
// collisions, too.
enum class UrdfScope { kDynamics, kShapes };

// A URDF reduced to what rigid-body dynamics needs, rewritten so that any parser reads it alike:
// only <link> with <inertial>, and <joint> with <origin>, <parent>, <child>, <axis>, <limit> and
// <mimic>; every number has been parsed, is finite and is written back exactly.
struct UrdfText {
  struct Joint {
    std::string name, parent, child;
  };
  std::string xml;
  std::string root;                // name of the link that no joint moves
  std::vector<std::string> links;  // names; both lists in the order of the text
  std::vector<Joint> joints;
};

// The judge of all robot descriptions.
// Throws UrdfError naming line or element: text that is not well-formed XML, too large, not a
// robot; elements given twice, incomplete or without name; numbers that are none, not finite or
// absurd; joints of no known type, without limits that they need, with limits upside down or an
// axis of length zero; links and joints that do not form one tree.
UrdfText reduce_urdf(std::string_view text, XmlEncoding encoding,
                     UrdfScope scope = UrdfScope::kDynamics);

}  // namespace codesign::dynamics
