#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/model.hpp"
#include "dynamics/urdf/xml_reader.hpp"

namespace codesign::dynamics {

// What of a URDF becomes the model.
struct UrdfOptions {
  // Names of the joints that move, in the wanted order; all others are locked at position 0 and
  // their links lumped. Absent: every joint that is not fixed, in the order of the URDF text.
  std::optional<std::vector<std::string>> joints = std::nullopt;
  // Accept inertia tensors that no body can have (the published iRonCub robots hold some);
  // nothing else is waived.
  bool as_published = false;
  // The root link does not move.
  bool fixed_base = false;
};

// The robot in a URDF, given as text or as the path of a file. Text is what starts with '<' after
// white space. <dynamics>, visuals, collisions and everything that is not a link or a joint are
// ignored.
// Throws UrdfError naming the element for anything that cannot be simulated.
Model load_urdf(const std::string& text_or_path, const UrdfOptions& options = {});

// Judges a robot of which nothing is to fly yet: what load_urdf refuses in its text, the shapes and
// colors of visuals and collisions, and, if not as_published, inertias that no body can have.
// Joints of every type move; the mass matrix is not asked for. Returns the name of the root link.
// Throws UrdfError naming all faults.
std::string check_urdf(std::string_view text, XmlEncoding encoding, bool as_published = false);

// The rule for what mass, and inertia about the center of mass, of a link a body can have: point
// masses and thin rods pass, and tensors that miss the triangle inequality by rounding.
// Throws UrdfError naming the link and its principal moments.
void check_inertia(const RigidInertia& body, const std::string& link);

}  // namespace codesign::dynamics
