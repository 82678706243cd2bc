#include "dynamics/urdf/bodies.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "dynamics/forward_dynamics.hpp"
#include "dynamics/rigid_body.hpp"

namespace codesign::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Principal moments [kg m²] of rounded or measured tensors miss the triangle inequality by a
// little. The brackets of the published robots, which fly well, miss it by up to 1.97 % of the
// largest moment.
constexpr double kTriangleTolerance = 0.02;
// A zero moment of a point mass or a thin rod may come out negative by rounding.
constexpr double kRounding = 1e-9;  // of the largest moment
// [m] Moments of a body with a radius of gyration below this count as zero.
constexpr double kSmallestRadius = 1e-6;
// A pivot of the mass matrix below this share of its diagonal entry is rounding.
constexpr double kSmallestPivot = 1e-12;

std::string list(const Vector3d& moments) {
  return short_number(moments[0]) + ", " + short_number(moments[1]) + ", " +
         short_number(moments[2]) + " kg m2";
}

// The robot in a posture without symmetries.
struct GeneralPosture {
  explicit GeneralPosture(const Model& model) : kin(model), inertia(model) {
    constexpr double kGolden = 0.6180339887498949;
    Eigen::VectorXd s(model.joint_count());
    for (Eigen::Index i = 0; i < s.size(); ++i) {
      s[i] = 0.2 + 0.6 * std::fmod(kGolden * static_cast<double>(i + 1), 1.0);
    }
    forward_kinematics(model, {}, s, kin);
    compute_inertias(model, kin, inertia);
  }
  KinematicsData kin;
  InertiaData inertia;
};

// First row of a symmetric matrix whose pivot is rounding, in this order; kNone if it is regular.
// scale: of each row, what its pivot was made of.
int singular_row(Eigen::MatrixXd M, const Eigen::VectorXd& scale, const std::vector<int>& order) {
  for (std::size_t k = 0; k < order.size(); ++k) {
    const int p = order[k];
    if (!(std::abs(M(p, p)) > kSmallestPivot * std::abs(scale[p]))) return p;
    for (std::size_t i = k + 1; i < order.size(); ++i) {
      const double share = M(order[i], p) / M(p, p);
      for (std::size_t j = k + 1; j < order.size(); ++j) {
        M(order[i], order[j]) -= share * M(p, order[j]);
      }
    }
  }
  return kNone;
}

// Where bodies share joints: by the mass matrix, base first, then joints, parents first.
int singular_coordinate_of_matrix(const Model& model, const GeneralPosture& posture) {
  Eigen::MatrixXd M(model.dofs(), model.dofs());
  mass_matrix(model, posture.kin, posture.inertia, M);
  std::vector<int> order;
  for (int i = 0; i < model.base_dofs(); ++i) order.push_back(i);
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    const int column = model.column(model.bodies[i]);
    if (std::find(order.begin(), order.end(), column) == order.end()) order.push_back(column);
  }
  return singular_row(M, M.diagonal(), order);
}

// By the articulated inertias that the joints see, from the leaves to the base: any size of robot.
int singular_coordinate_of_tree(const Model& model, const GeneralPosture& posture) {
  VelocityData velocity(model);
  forward_velocities(model, posture.kin, Eigen::VectorXd::Zero(model.dofs()), velocity);
  ArticulatedData articulated(model);
  Eigen::VectorXd nu_dot(model.dofs());
  forward_dynamics(model, posture.kin, posture.inertia, velocity,
                   Eigen::VectorXd::Zero(model.joint_count()), {}, articulated, nu_dot);
  for (std::size_t i = model.bodies.size() - 1; i > 0; --i) {
    const BodyPose& pose = posture.kin.bodies[i];
    const RigidInertia& subtree = posture.inertia.subtrees[i];
    const Matrix3d rigid = subtree.inertia + point_inertia(subtree.mass, subtree.com - pose.p);
    const double scale = model.bodies[i].type == JointType::kPrismatic
                             ? subtree.mass
                             : pose.axis().dot(rigid * pose.axis());
    if (!(std::abs(articulated.bodies[i].joint_inertia) > kSmallestPivot * std::abs(scale))) {
      return model.column(model.bodies[i]);
    }
  }
  if (model.fixed_base) return kNone;
  const ArticulatedData::Body& base = articulated.bodies[0];
  const RigidInertia& all = posture.inertia.subtrees[0];
  Eigen::MatrixXd M(kBaseDofs, kBaseDofs);
  M << base.linear, base.coupling, base.coupling.transpose(), base.angular;
  Eigen::VectorXd scale(kBaseDofs);
  scale << Vector3d::Constant(all.mass),
      (all.inertia + point_inertia(all.mass, all.com)).diagonal();
  return singular_row(M, scale, {0, 1, 2, 3, 4, 5});
}

// A coordinate of a model that moves nothing with mass; kNone if the mass matrix is regular.
int singular_coordinate(const Model& model) {
  const GeneralPosture posture(model);
  return model.mimics ? singular_coordinate_of_matrix(model, posture)
                      : singular_coordinate_of_tree(model, posture);
}

std::string singular_motion(const Model& model) {
  const int coordinate = singular_coordinate(model);
  if (coordinate == kNone) return {};
  const std::string root = "link " + in_quotes(model.bodies.front().name);
  const int joint = coordinate - model.base_dofs();
  std::string words =
      (joint < 0 ? root
                 : "joint " + in_quotes(model.joints[static_cast<std::size_t>(joint)].name)) +
      " can move without anything that has mass or inertia: the mass matrix is singular";
  Model held = model;
  held.fixed_base = true;
  if (!model.fixed_base && singular_coordinate(held) == kNone) {
    words += "; fixed_base=True, which holds " + root + ", accepts it";
  }
  return words;
}

}  // namespace

std::string in_quotes(std::string name) {
  constexpr std::size_t kLongest = 120;
  if (name.size() > kLongest) name = name.substr(0, kLongest) + "...";
  std::replace_if(
      name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '?');
  return "\"" + name + "\"";
}

std::string short_number(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::general, 6);
  return {buffer.data(), end.ptr};
}

std::string inertia_fault(const RigidInertia& body) {
  if (body.mass < 0.0) return "negative mass " + short_number(body.mass) + " kg";
  const Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Matrix3d>(body.inertia, Eigen::EigenvaluesOnly)
          .eigenvalues();  // ascending
  if (body.mass == 0.0 && !moments.isZero(0.0)) {
    return "non-physical inertia, principal moments without mass: " + list(moments);
  }
  const double slack = kRounding * moments[2] + kSmallestRadius * kSmallestRadius * body.mass;
  if (moments[0] < -slack) {
    return "non-physical inertia, a principal moment is negative: " + list(moments);
  }
  if (moments[2] > moments[0] + moments[1] + kTriangleTolerance * moments[2] + slack) {
    return "non-physical inertia, a principal moment exceeds the sum of the others: " +
           list(moments);
  }
  return {};
}

std::vector<std::string> inertia_faults(const Model& model) {
  std::vector<std::string> faults;
  for (const Body& body : model.bodies) {
    const bool held = model.fixed_base && body.parent == kNone;
    const std::string fault = held ? std::string{} : inertia_fault(body.inertia);
    if (!fault.empty()) {
      const auto index = static_cast<int>(&body - model.bodies.data());
      const auto links = std::count_if(model.frames.begin(), model.frames.end(),
                                       [&](const Frame& frame) { return frame.body == index; });
      faults.push_back("link " + in_quotes(body.name) +
                       (links > 1 ? " with those fixed to it" : "") + ": " + fault +
                       "; as_published accepts it");
    }
  }
  return faults;
}

std::vector<std::string> body_faults(const Model& model, bool as_published) {
  std::vector<std::string> faults;
  if (!as_published) faults = inertia_faults(model);
  if (faults.empty()) {
    const std::string singular = singular_motion(model);
    if (!singular.empty()) faults.push_back(singular);
  }
  return faults;
}

}  // namespace codesign::dynamics
