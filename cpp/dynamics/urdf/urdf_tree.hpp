#pragma once

#include <string>

#include "dynamics/urdf/urdf_text.hpp"

namespace codesign::dynamics {

// Name of the link that no joint moves. Throws UrdfError unless the links and joints, each with a
// name of its own, form one tree.
std::string root_of_tree(const UrdfText& text);

}  // namespace codesign::dynamics
