#include "dynamics/urdf.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>

#include "errors.hpp"

namespace codesign::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::string quoted(const std::string& name) { return "\"" + name + "\""; }

// Collects what urdfdom prints, so that the first complaint can become the error message.
class MessageCollector : public console_bridge::OutputHandler {
 public:
  MessageCollector() { console_bridge::useOutputHandler(this); }
  ~MessageCollector() override { console_bridge::restorePreviousOutputHandler(); }
  MessageCollector(const MessageCollector&) = delete;
  MessageCollector& operator=(const MessageCollector&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_error_.empty()) {
      first_error_ = text;
    }
  }
  const std::string& first_error() const { return first_error_; }

 private:
  std::string first_error_;
};

urdf::ModelInterfaceSharedPtr parse(const std::string& text) {
  static std::mutex mutex;  // console_bridge's handler is global
  const std::lock_guard<std::mutex> lock(mutex);
  MessageCollector messages;
  urdf::ModelInterfaceSharedPtr urdf;
  try {
    urdf = urdf::parseURDF(text);
  } catch (const std::exception& e) {
    throw UrdfError(std::string("URDF: ") + e.what());
  }
  if (!urdf) {
    throw UrdfError("URDF: " + (messages.first_error().empty() ? std::string("not a robot")
                                                               : messages.first_error()));
  }
  return urdf;
}

Pose pose_of(const urdf::Pose& pose) {
  const Eigen::Quaterniond rotation(pose.rotation.w, pose.rotation.x, pose.rotation.y,
                                    pose.rotation.z);
  return {rotation.normalized().toRotationMatrix(),
          Vector3d(pose.position.x, pose.position.y, pose.position.z)};
}

RigidInertia inertia_of(const urdf::Inertial& inertial) {
  Matrix3d tensor;
  tensor << inertial.ixx, inertial.ixy, inertial.ixz,  //
      inertial.ixy, inertial.iyy, inertial.iyz,        //
      inertial.ixz, inertial.iyz, inertial.izz;
  return transform(pose_of(inertial.origin), {inertial.mass, Vector3d::Zero(), tensor});
}

void check_inertia(const RigidInertia& body, const std::string& link, bool as_published) {
  if (!(body.mass >= 0.0)) throw UrdfError("link " + quoted(link) + ": negative mass");
  if (as_published || body.mass == 0.0) return;
  const Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Matrix3d>(body.inertia, Eigen::EigenvaluesOnly).eigenvalues();
  constexpr double kTriangleTolerance = 1e-3;
  if (moments[0] <= 0.0 || moments[2] > (1.0 + kTriangleTolerance) * (moments[0] + moments[1])) {
    std::ostringstream message;
    message << "link " << quoted(link) << ": non-physical inertia, principal moments "
            << moments.transpose() << " kg m2";
    throw UrdfError(message.str());
  }
}

Joint joint_of(const urdf::Joint& urdf) {
  Joint joint;
  joint.name = urdf.name;
  joint.type = urdf.type == urdf::Joint::PRISMATIC ? JointType::kPrismatic : JointType::kRevolute;
  joint.continuous = urdf.type == urdf::Joint::CONTINUOUS;
  if (urdf.limits) {
    if (!joint.continuous) {
      joint.lower = urdf.limits->lower;
      joint.upper = urdf.limits->upper;
    }
    joint.velocity = urdf.limits->velocity;
    joint.effort = urdf.limits->effort;
  }
  return joint;
}

// A rotation that takes z to the axis; exact for coordinate axes.
Matrix3d rotation_to_axis(const Vector3d& axis) {
  Eigen::Index smallest = 0;
  axis.cwiseAbs().minCoeff(&smallest);
  const Vector3d x = axis.cross(Vector3d::Unit(smallest)).normalized();
  Matrix3d R;
  R << x, axis.cross(x), axis;
  return R;
}

// Builds the tree of moving bodies from the tree of links.
class Builder {
 public:
  Builder(const urdf::ModelInterface& urdf, const UrdfOptions& options)
      : urdf_(urdf), options_(options) {
    model_.name = urdf.getName();
    model_.fixed_base = options.fixed_base;
    select_joints();
  }

  Model build() {
    Body base;
    base.name = urdf_.getRoot()->name;
    model_.bodies.push_back(base);
    std::vector<Place> open = {{urdf_.getRoot().get(), 0, Pose{}}};
    while (!open.empty()) {
      const Place place = open.back();
      open.pop_back();
      add_link(place);
      for (const urdf::JointSharedPtr& joint : place.link->child_joints) {
        open.push_back(child_of(place, *joint));
      }
    }
    for (const Body& body : model_.bodies) {
      model_.total_mass += body.inertia.mass;
      if (!(body.inertia.mass > 0.0) && !(model_.fixed_base && body.parent == kNone)) {
        throw UrdfError("link " + quoted(body.name) + " moves but has no mass");
      }
    }
    return std::move(model_);
  }

 private:
  struct Place {
    const urdf::Link* link;
    int body;
    Pose body_T_link;
  };

  static bool movable(const urdf::Joint& joint) { return joint.type != urdf::Joint::FIXED; }

  void select_joints() {
    std::vector<std::string> names;
    if (options_.joints) {
      names = *options_.joints;
    } else {
      for (const auto& [name, joint] : urdf_.joints_) {
        if (movable(*joint)) names.push_back(name);
      }
    }
    for (const std::string& name : names) {
      const urdf::JointConstSharedPtr joint = urdf_.getJoint(name);
      if (!joint) throw UnknownNameError("the URDF has no joint " + quoted(name));
      check_movable(*joint);
      if (!order_.emplace(name, model_.joint_count()).second) {
        throw UrdfError("joint " + quoted(name) + " is selected twice");
      }
      model_.joints.push_back(joint_of(*joint));
    }
  }

  static void check_movable(const urdf::Joint& joint) {
    const bool single_axis = joint.type == urdf::Joint::REVOLUTE ||
                             joint.type == urdf::Joint::CONTINUOUS ||
                             joint.type == urdf::Joint::PRISMATIC;
    if (!single_axis) {
      throw UrdfError("joint " + quoted(joint.name) +
                      ": only revolute, continuous and prismatic joints can move");
    }
    if (joint.mimic) throw UrdfError("joint " + quoted(joint.name) + ": mimic is not supported");
  }

  void add_link(const Place& place) {
    const urdf::Link& link = *place.link;
    model_.frames.push_back({link.name, place.body, place.body_T_link});
    if (!link.inertial) return;
    const RigidInertia own = inertia_of(*link.inertial);
    check_inertia(own, link.name, options_.as_published);
    RigidInertia& body = model_.bodies[static_cast<std::size_t>(place.body)].inertia;
    body = body + transform(place.body_T_link, own);
  }

  Place child_of(const Place& parent, const urdf::Joint& urdf) {
    const urdf::Link* child = urdf_.getLink(urdf.child_link_name).get();
    const Pose body_T_joint = parent.body_T_link * pose_of(urdf.parent_to_joint_origin_transform);
    const auto selected = order_.find(urdf.name);
    if (selected == order_.end()) return {child, parent.body, body_T_joint};
    const Vector3d axis(urdf.axis.x, urdf.axis.y, urdf.axis.z);
    const Pose joint_T_body{rotation_to_axis(axis.normalized()), Vector3d::Zero()};
    Body body;
    body.name = child->name;
    body.parent = parent.body;
    body.joint = selected->second;
    body.type = model_.joints[static_cast<std::size_t>(body.joint)].type;
    body.parent_T_body = body_T_joint * joint_T_body;
    model_.bodies.push_back(body);
    return {child, model_.body_count() - 1, inverse(joint_T_body)};
  }

  const urdf::ModelInterface& urdf_;
  const UrdfOptions& options_;
  std::map<std::string, int> order_;  // joint name → index in Model::joints
  Model model_;
};

std::string read_text(const std::string& text_or_path) {
  const std::size_t start = text_or_path.find_first_not_of(" \t\r\n");
  if (start != std::string::npos && text_or_path[start] == '<') return text_or_path;
  std::ifstream file(text_or_path, std::ios::binary);
  if (!file) throw UrdfError("cannot read the URDF file " + quoted(text_or_path));
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

Model load_urdf(const std::string& text_or_path, const UrdfOptions& options) {
  const urdf::ModelInterfaceSharedPtr urdf = parse(read_text(text_or_path));
  return Builder(*urdf, options).build();
}

}  // namespace codesign::dynamics
