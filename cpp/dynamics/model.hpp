#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/spatial.hpp"

// The robot as the algorithms see it: a tree of *moving* bodies. Links behind fixed or locked
// joints are lumped into the moving body that carries them when the model is built, and stay
// reachable as frames. A Model is built once (urdf.hpp) and passed const; scratch lives in structs
// of its own.
//
// Coordinates. q = (base pose, s), velocity nu = (base linear velocity, base angular velocity, ṡ):
// velocity of the base link's origin and angular velocity, both in world axes ("mixed"), then the
// joints in the wanted order. With a fixed base nu = ṡ, and every matrix loses its six base rows
// and columns.
namespace codesign::dynamics {

inline constexpr int kBaseDofs = 6;
inline constexpr double kGravity = 9.81;  // [m/s²], along -z of the world
inline constexpr int kNone = -1;

// How a joint moves.
enum class JointType { kRevolute, kPrismatic };

// A joint that moves; position 0 is the URDF's zero. Limits are stored for information only.
struct Joint {
  std::string name;
  JointType type = JointType::kRevolute;
  bool continuous = false;
  double lower = -std::numeric_limits<double>::infinity();    // [rad] or [m]
  double upper = std::numeric_limits<double>::infinity();     // [rad] or [m]
  double velocity = std::numeric_limits<double>::infinity();  // [rad/s] or [m/s]
  double effort = std::numeric_limits<double>::infinity();    // [N m] or [N]
};

// A moving body. Its axes are chosen so that it moves along or about its own z axis; its origin is
// the joint's origin. Body 0 is the base: its axes and origin are those of the root link.
struct Body {
  std::string name;    // the URDF link that the joint moves
  int parent = kNone;  // index of a body that comes earlier
  int joint = kNone;   // index into Model::joints, kNone for the base
  JointType type = JointType::kRevolute;
  // Position of the body on its joint: ratio times the joint's, plus offset [rad] or [m]. Of bodies
  // that mimic a joint they are those of the URDF; several bodies then share one joint.
  double ratio = 1.0, offset = 0.0;
  Pose parent_T_body;    // at joint position 0
  RigidInertia inertia;  // body axes, all lumped links included
};

// Any link of the URDF, as a frame fixed to a moving body.
struct Frame {
  std::string name;
  int body = 0;
  Pose body_T_frame;
};

// A robot as the algorithms see it: a tree of moving bodies, SI units.
struct Model {
  std::string name;
  bool fixed_base = false;
  std::vector<Joint> joints;  // in the wanted order
  std::vector<Body> bodies;   // parents before children
  std::vector<Frame> frames;  // in the order of the URDF text
  double total_mass = 0.0;    // [kg]
  bool mimics = false;        // some bodies share a joint

  int joint_count() const { return static_cast<int>(joints.size()); }
  int body_count() const { return static_cast<int>(bodies.size()); }
  int base_dofs() const { return fixed_base ? 0 : kBaseDofs; }
  int dofs() const { return base_dofs() + joint_count(); }
  int column(const Body& body) const { return base_dofs() + body.joint; }  // of nu and of matrices
};

// Index into Model::frames or Model::joints. Throws UnknownNameError, which lists what is there.
int frame_index(const Model& model, std::string_view name);
int joint_index(const Model& model, std::string_view name);

}  // namespace codesign::dynamics
