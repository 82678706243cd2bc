#include "dynamics/urdf.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>

#include "dynamics/urdf_text.hpp"
#include "errors.hpp"

namespace codesign::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Principal moments [kg m²] of rounded or measured tensors miss the triangle inequality by a
// little. The brackets of the published robots, which fly well, miss it by up to 1.97 % of the
// largest moment.
constexpr double kTriangleTolerance = 0.02;
// A zero moment of a point mass or a thin rod may come out negative by rounding.
constexpr double kRounding = 1e-9;        // of the largest moment
constexpr double kSmallestMass = 1e-9;    // [kg] of a moving body
constexpr double kSmallestRadius = 1e-6;  // [m] of gyration of a moving body
constexpr double kSmallestAxis = 1e-3;    // norm before it is normalized

std::string in_quotes(std::string name) {
  constexpr std::size_t kLongest = 120;
  if (name.size() > kLongest) name = name.substr(0, kLongest) + "...";
  std::replace_if(
      name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '?');
  return "\"" + name + "\"";
}

// Short, and the same in every locale.
std::string number(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::general, 6);
  return {buffer.data(), end.ptr};
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

Vector3d principal_moments(const RigidInertia& body) {
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(body.inertia, Eigen::EigenvaluesOnly)
      .eigenvalues();  // ascending
}

std::string list(const Vector3d& moments) {
  return number(moments[0]) + ", " + number(moments[1]) + ", " + number(moments[2]) + " kg m2";
}

double smallest_moment(const RigidInertia& body) {
  return kSmallestRadius * kSmallestRadius * body.mass;
}

// What one <inertial> must fulfill. Point masses and thin rods pass.
void check_link_inertia(const RigidInertia& link, const std::string& name, bool as_published) {
  if (link.mass < 0.0) {
    throw UrdfError("link " + in_quotes(name) + ": negative mass " + number(link.mass) + " kg");
  }
  if (as_published) return;
  const Vector3d moments = principal_moments(link);
  if (link.mass == 0.0 && !moments.isZero(0.0)) {
    throw UrdfError("link " + in_quotes(name) +
                    ": non-physical inertia, principal moments without mass: " + list(moments));
  }
  const double slack = kRounding * moments[2] + smallest_moment(link);
  if (moments[0] < -slack) {
    throw UrdfError("link " + in_quotes(name) +
                    ": non-physical inertia, a principal moment is negative: " + list(moments));
  }
  if (moments[2] > moments[0] + moments[1] + kTriangleTolerance * moments[2] + slack) {
    throw UrdfError("link " + in_quotes(name) +
                    ": non-physical inertia, a principal moment exceeds the sum of the others: " +
                    list(moments) + "; as_published accepts it");
  }
}

// What a moving body, lumped from its links, must fulfill for the equations of motion to be
// regular.
void check_moving_body(const Body& body, bool as_published) {
  if (body.inertia.mass < kSmallestMass) {
    throw UrdfError("link " + in_quotes(body.name) +
                    " moves but has no mass (with the links fixed to it " +
                    number(body.inertia.mass) + " kg)");
  }
  if (as_published) return;
  const Vector3d moments = principal_moments(body.inertia);
  if (moments[0] <= smallest_moment(body.inertia)) {
    throw UrdfError("link " + in_quotes(body.name) +
                    " moves: non-physical inertia, principal moments with the links fixed to it "
                    "are not positive: " +
                    list(moments));
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
  const Vector3d x = (Vector3d::Unit(smallest) - axis[smallest] * axis).normalized();
  Matrix3d R;
  R << x, axis.cross(x), axis;
  return R;
}

// Builds the tree of moving bodies from the tree of links.
class Builder {
 public:
  Builder(const urdf::ModelInterface& urdf, const UrdfText& text, const UrdfOptions& options)
      : urdf_(urdf), text_(text), options_(options) {
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
    finish();
    return std::move(model_);
  }

 private:
  struct Place {
    const urdf::Link* link;
    int body;
    Pose body_T_link;
  };

  void select_joints() {
    std::vector<std::string> names;
    if (options_.joints) {
      names = *options_.joints;
    } else {
      for (const UrdfText::Joint& joint : text_.joints) {
        if (urdf_.getJoint(joint.name)->type != urdf::Joint::FIXED) names.push_back(joint.name);
      }
    }
    for (const std::string& name : names) {
      const urdf::JointConstSharedPtr joint = urdf_.getJoint(name);
      if (!joint) {
        throw UnknownNameError("robot " + in_quotes(model_.name) + " has no joint " +
                               in_quotes(name));
      }
      check_movable(*joint);
      if (!order_.emplace(name, model_.joint_count()).second) {
        throw UrdfError("joint " + in_quotes(name) + " is selected twice");
      }
      model_.joints.push_back(joint_of(*joint));
    }
  }

  static void check_movable(const urdf::Joint& joint) {
    const bool single_axis = joint.type == urdf::Joint::REVOLUTE ||
                             joint.type == urdf::Joint::CONTINUOUS ||
                             joint.type == urdf::Joint::PRISMATIC;
    if (!single_axis) {
      const char* type = joint.type == urdf::Joint::FLOATING ? "floating"
                         : joint.type == urdf::Joint::PLANAR ? "planar"
                                                             : "fixed";
      throw UrdfError("joint " + in_quotes(joint.name) + " is " + type +
                      ": only revolute, continuous and prismatic joints can move; a model with "
                      "joints=[...] moves those it names and locks the others");
    }
    if (joint.mimic) {
      throw UrdfError("joint " + in_quotes(joint.name) + " mimics joint " +
                      in_quotes(joint.mimic->joint_name) +
                      ", which is not supported: leave it out of the joints to lock it at 0");
    }
    if (Vector3d(joint.axis.x, joint.axis.y, joint.axis.z).norm() < kSmallestAxis) {
      throw UrdfError("joint " + in_quotes(joint.name) + " has no axis: its norm is zero");
    }
  }

  void add_link(const Place& place) {
    const urdf::Link& link = *place.link;
    model_.frames.push_back({link.name, place.body, place.body_T_link});
    if (!link.inertial) return;
    const RigidInertia own = inertia_of(*link.inertial);
    check_link_inertia(own, link.name, options_.as_published);
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

  void finish() {
    for (const Body& body : model_.bodies) {
      model_.total_mass += body.inertia.mass;
      const bool moves = !(model_.fixed_base && body.parent == kNone);
      if (moves) check_moving_body(body, options_.as_published);
    }
    if (!(model_.total_mass > 0.0))
      throw UrdfError("robot " + in_quotes(model_.name) + " has no mass");
    std::map<std::string, std::size_t> place;
    for (const std::string& link : text_.links) place.emplace(link, place.size());
    std::sort(model_.frames.begin(), model_.frames.end(),
              [&](const Frame& a, const Frame& b) { return place.at(a.name) < place.at(b.name); });
  }

  const urdf::ModelInterface& urdf_;
  const UrdfText& text_;
  const UrdfOptions& options_;
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

Model load_text(const std::string& text, XmlEncoding encoding, const UrdfOptions& options) {
  const UrdfText reduced = reduce_urdf(text, encoding);
  const urdf::ModelInterfaceSharedPtr urdf = parse(reduced.xml);
  struct Release {
    const urdf::ModelInterfaceSharedPtr& urdf;
    ~Release() { release(urdf); }
  } const releaser{urdf};
  return Builder(*urdf, reduced, options).build();
}

}  // namespace

void check_inertia(const RigidInertia& body, const std::string& link) {
  check_link_inertia(body, link, false);
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
