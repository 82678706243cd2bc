#pragma once

#include <string>
#include <vector>

#include "dynamics/model.hpp"

// What the masses of a URDF must fulfill, link by link and lumped into the bodies that move.
namespace codesign::dynamics {

// A name or a number of a file in a message: short, without control characters; the same in every
// locale.
std::string in_quotes(std::string name);
std::string short_number(double value);

// Why no body can have this mass and this inertia about the center of mass; empty if one can. Point
// masses and thin rods pass, and tensors that miss the triangle inequality by rounding.
std::string inertia_fault(const RigidInertia& body);

// Faults of the bodies that move, in words: inertias that no body can have (not asked for if
// as_published), and the motion whose row makes the mass matrix singular in a general posture.
// Bodies without mass pass if the matrix is regular (crosses of universal joints).
std::vector<std::string> body_faults(const Model& model, bool as_published);

// The first of the two alone.
std::vector<std::string> inertia_faults(const Model& model);

}  // namespace codesign::dynamics
