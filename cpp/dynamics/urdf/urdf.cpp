#include "dynamics/urdf/urdf.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>

#include "dynamics/urdf/bodies.hpp"
#include "dynamics/urdf/urdf_text.hpp"
#include "errors.hpp"

namespace codesign::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSmallestAxis = 1e-3;   // norm before it is normalized
constexpr std::size_t kMostFaults = 20;  // in a message

[[noreturn]] void refuse(const std::vector<std::string>& faults) {
  std::string words;
  for (std::size_t i = 0; i < std::min(faults.size(), kMostFaults); ++i) {
    words += (i == 0 ? "" : "; ") + faults[i];
  }
  if (faults.size() > kMostFaults) {
    words += "; and " + std::to_string(faults.size() - kMostFaults) + " more";
  }
  throw UrdfError(words);
}

// Collects the errors that urdfdom would print; the last ones name the element.
class MessageCollector : public console_bridge::OutputHandler {
 public:
  MessageCollector() { console_bridge::useOutputHandler(this); }
  ~MessageCollector() override { console_bridge::restorePreviousOutputHandler(); }
  MessageCollector(const MessageCollector&) = delete;
  MessageCollector& operator=(const MessageCollector&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    constexpr std::size_t kEnough = 500;
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR || errors_.size() > kEnough) return;
    errors_ += (errors_.empty() ? "" : "; ") + text;
  }
  const std::string& errors() const { return errors_; }

 private:
  std::string errors_;
};

// Takes the links apart one by one: the chain of owners is as long as the robot is deep, and would
// be released by recursion.
void release(const urdf::ModelInterfaceSharedPtr& urdf) {
  for (const auto& [name, link] : urdf->links_) {
    link->child_links.clear();
    link->child_joints.clear();
  }
}

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
  // It also returns robots with elements that it could not read: they are not what the text says.
  if (!urdf || !messages.errors().empty()) {
    if (urdf) release(urdf);
    throw UrdfError("URDF: " + messages.errors());
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
  const Vector3d x = (Vector3d::Unit(smallest) - axis[smallest] * axis).normalized();
  Matrix3d R;
  R << x, axis.cross(x), axis;
  return R;
}

// Position of a joint as a function of an independent one: ratio times its position, plus offset.
struct Mimic {
  std::string joint;  // empty: it does not depend on any, and stays at the offset
  double ratio = 1.0, offset = 0.0;
};

// Motion of a joint's child at a position that never changes.
Pose displacement(const urdf::Joint& joint, double position) {
  const Vector3d axis = Vector3d(joint.axis.x, joint.axis.y, joint.axis.z).normalized();
  if (joint.type == urdf::Joint::PRISMATIC) return {Matrix3d::Identity(), position * axis};
  return {Eigen::AngleAxisd(position, axis).toRotationMatrix(), Vector3d::Zero()};
}

bool has_one_axis(const urdf::Joint& joint) {
  return joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS ||
         joint.type == urdf::Joint::PRISMATIC;
}

// Builds the tree of moving bodies from the tree of links.
class Builder {
 public:
  Builder(const urdf::ModelInterface& urdf, const UrdfText& text, const UrdfOptions& options)
      : urdf_(urdf), text_(text), options_(options) {
    model_.name = urdf.getName();
    model_.fixed_base = options.fixed_base;
  }

  Model build() {
    grow();
    finish();
    return std::move(model_);
  }

  // Refuses inertias that no body can have; joints of every type move.
  void judge() {
    every_joint_moves_ = true;
    grow();
    if (faults_.empty()) faults_ = inertia_faults(model_);
    if (!faults_.empty()) refuse(faults_);
  }

 private:
  struct Place {
    const urdf::Link* link;
    int body;
    Pose body_T_link;
  };

  void grow() {
    select_joints();
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
  }

  void select_joints() {
    std::vector<std::string> names;
    if (options_.joints) {
      names = *options_.joints;
    } else {
      for (const UrdfText::Joint& item : text_.joints) {
        const urdf::JointConstSharedPtr joint = urdf_.getJoint(item.name);
        const bool follows = has_one_axis(*joint) && joint->mimic;
        const bool moves =
            every_joint_moves_ ? has_one_axis(*joint) : joint->type != urdf::Joint::FIXED;
        if (moves && !follows) names.push_back(item.name);
      }
    }
    for (const std::string& name : names) {
      const urdf::JointConstSharedPtr joint = urdf_.getJoint(name);
      if (!joint) {
        throw UnknownNameError("robot " + in_quotes(model_.name) + " has no joint " +
                               in_quotes(name));
      }
      if (!is_movable(*joint)) continue;
      if (!order_.emplace(name, model_.joint_count()).second) {
        throw UrdfError("joint " + in_quotes(name) + " is selected twice");
      }
      model_.joints.push_back(joint_of(*joint));
    }
  }

  bool is_movable(const urdf::Joint& joint) {
    const std::string words = "joint " + in_quotes(joint.name);
    if (!has_one_axis(joint)) {
      const char* type = joint.type == urdf::Joint::FLOATING ? "floating"
                         : joint.type == urdf::Joint::PLANAR ? "planar"
                                                             : "fixed";
      faults_.push_back(words + " is " + type +
                        ": only revolute, continuous and prismatic joints can move; a model with "
                        "joints=[...] moves those it names and locks the others");
    } else if (joint.mimic) {
      faults_.push_back(words + " mimics joint " + in_quotes(joint.mimic->joint_name) +
                        ": name that one, and it moves along");
    } else {
      return true;
    }
    return false;
  }

  // What an unselected joint follows, through joints that mimic others themselves.
  Mimic followed(const urdf::Joint& urdf) {
    Mimic mimic{urdf.name};
    const urdf::Joint* joint = &urdf;
    for (std::size_t steps = 0; order_.find(joint->name) == order_.end(); ++steps) {
      if (!has_one_axis(*joint) || !joint->mimic) return {{}, 0.0, mimic.offset};
      const urdf::JointConstSharedPtr next = urdf_.getJoint(joint->mimic->joint_name);
      const std::string words = "joint " + in_quotes(joint->name) + " mimics joint " +
                                in_quotes(joint->mimic->joint_name);
      if (!next || steps > text_.joints.size()) {
        faults_.push_back(words + (next ? ", which mimics it in turn" : ", which does not exist"));
        return {{}, 0.0, 0.0};
      }
      mimic = {next->name, mimic.ratio * joint->mimic->multiplier,
               mimic.offset + mimic.ratio * joint->mimic->offset};
      joint = next.get();
    }
    return mimic;
  }

  void add_link(const Place& place) {
    const urdf::Link& link = *place.link;
    model_.frames.push_back({link.name, place.body, place.body_T_link});
    if (!link.inertial) return;
    const RigidInertia own = inertia_of(*link.inertial);
    if (own.mass < 0.0) {
      faults_.push_back("link " + in_quotes(link.name) + ": negative mass " +
                        short_number(own.mass) + " kg");
    }
    RigidInertia& body = model_.bodies[static_cast<std::size_t>(place.body)].inertia;
    body = body + transform(place.body_T_link, own);
  }

  Place child_of(const Place& parent, const urdf::Joint& urdf) {
    const urdf::Link* child = urdf_.getLink(urdf.child_link_name).get();
    const Pose body_T_joint = parent.body_T_link * pose_of(urdf.parent_to_joint_origin_transform);
    if (every_joint_moves_ && !has_one_axis(urdf) && urdf.type != urdf::Joint::FIXED) {
      Body body;
      body.name = child->name;
      body.parent = parent.body;
      model_.bodies.push_back(body);
      return {child, model_.body_count() - 1, {}};
    }
    const Mimic mimic = followed(urdf);
    if (mimic.joint.empty() || mimic.ratio == 0.0) {
      const bool displaced = mimic.offset != 0.0;
      return {child, parent.body,
              displaced ? body_T_joint * displacement(urdf, mimic.offset) : body_T_joint};
    }
    const Vector3d axis(urdf.axis.x, urdf.axis.y, urdf.axis.z);
    if (axis.norm() < kSmallestAxis) {
      faults_.push_back("joint " + in_quotes(urdf.name) + " has no axis: its norm is zero");
    }
    const Pose joint_T_body{rotation_to_axis(axis.normalized()), Vector3d::Zero()};
    Body body;
    body.name = child->name;
    body.parent = parent.body;
    body.joint = order_.at(mimic.joint);
    body.type = urdf.type == urdf::Joint::PRISMATIC ? JointType::kPrismatic : JointType::kRevolute;
    body.ratio = mimic.ratio;
    body.offset = mimic.offset;
    model_.mimics = model_.mimics || mimic.joint != urdf.name;
    body.parent_T_body = body_T_joint * joint_T_body;
    model_.bodies.push_back(body);
    return {child, model_.body_count() - 1, inverse(joint_T_body)};
  }

  void finish() {
    for (const Body& body : model_.bodies) model_.total_mass += body.inertia.mass;
    if (faults_.empty() && !(model_.total_mass > 0.0)) {
      faults_.push_back("robot " + in_quotes(model_.name) + " has no mass");
    }
    if (faults_.empty()) faults_ = body_faults(model_, options_.as_published);
    if (!faults_.empty()) refuse(faults_);
    std::map<std::string, std::size_t> place;
    for (const std::string& link : text_.links) place.emplace(link, place.size());
    std::sort(model_.frames.begin(), model_.frames.end(),
              [&](const Frame& a, const Frame& b) { return place.at(a.name) < place.at(b.name); });
  }

  const urdf::ModelInterface& urdf_;
  const UrdfText& text_;
  const UrdfOptions& options_;
  bool every_joint_moves_ = false;
  std::vector<std::string> faults_;
  std::map<std::string, int> order_;  // joint name → index in Model::joints
  Model model_;
};

bool is_text(const std::string& text_or_path) {
  std::size_t start = text_or_path.starts_with("\xEF\xBB\xBF") ? 3 : 0;  // byte order mark
  start = text_or_path.find_first_not_of(" \t\r\n", start);
  return start != std::string::npos && text_or_path[start] == '<';
}

std::string read_file(const std::string& path) {
  std::error_code error;
  std::string text;
  if (std::filesystem::is_regular_file(path, error)) {
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (!error && size > kMaxUrdfBytes) throw UrdfError(in_quotes(path) + " is larger than 64 MiB");
    std::ifstream file(path, std::ios::binary);
    text.assign(std::istreambuf_iterator<char>(file), {});
    if (file && !error) return text;
  }
  throw UrdfError(in_quotes(path) +
                  " cannot be read as a file, and is no URDF text, which starts with '<'");
}

// A parsed robot that is taken apart at the end.
struct Parsed {
  explicit Parsed(const UrdfText& text) : urdf(parse(text.xml)) {}
  ~Parsed() { release(urdf); }
  Parsed(const Parsed&) = delete;
  Parsed& operator=(const Parsed&) = delete;
  urdf::ModelInterfaceSharedPtr urdf;
};

Model load_text(const std::string& text, XmlEncoding encoding, const UrdfOptions& options) {
  const UrdfText reduced = reduce_urdf(text, encoding);
  const Parsed parsed(reduced);
  return Builder(*parsed.urdf, reduced, options).build();
}

}  // namespace

std::string check_urdf(std::string_view text, XmlEncoding encoding, bool as_published) {
  const UrdfText reduced = reduce_urdf(text, encoding, UrdfScope::kShapes);
  if (!as_published) {
    const Parsed parsed(reduced);
    Builder(*parsed.urdf, reduced, {}).judge();
  }
  return reduced.root;
}

void check_inertia(const RigidInertia& body, const std::string& link) {
  const std::string fault = inertia_fault(body);
  if (!fault.empty()) {
    const bool published = body.mass >= 0.0;
    throw UrdfError("link " + in_quotes(link) + ": " + fault +
                    (published ? "; as_published accepts it" : ""));
  }
}

Model load_urdf(const std::string& text_or_path, const UrdfOptions& options) {
  if (is_text(text_or_path)) return load_text(text_or_path, XmlEncoding::kUtf8, options);
  const std::string text = read_file(text_or_path);
  try {
    return load_text(text, XmlEncoding::kDeclared, options);
  } catch (const UnknownNameError& e) {
    throw UnknownNameError(text_or_path + ": " + e.what());
  } catch (const UrdfError& e) {
    throw UrdfError(text_or_path + ": " + e.what());
  }
}

}  // namespace codesign::dynamics
