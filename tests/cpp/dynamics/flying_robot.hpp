#pragma once

#include <cmath>
#include <string>

#include "dynamics/flight_settings.hpp"
#include "dynamics/urdf/urdf.hpp"

// A small flying robot for tests: a trunk with two jets behind it and two arms of three joints (one
// of them prismatic on request), each with a jet at its end; the right side mirrors the left.
namespace codesign::dynamics::testing {

inline std::string link(const std::string& name, double mass, const std::string& xyz,
                        const std::string& tensor) {
  return "<link name=\"" + name + "\"><inertial><origin xyz=\"" + xyz + "\"/><mass value=\"" +
         std::to_string(mass) + "\"/><inertia " + tensor + "/></inertial></link>";
}

inline std::string joint(const std::string& name, const std::string& type,
                         const std::string& parent, const std::string& child,
                         const std::string& xyz, const std::string& axis,
                         const std::string& rpy = "0 0 0") {
  const std::string limit =
      type == "fixed" ? "" : "<limit lower=\"-3\" upper=\"3\" effort=\"100\" velocity=\"10\"/>";
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><origin xyz=\"" + xyz + "\" rpy=\"" +
         rpy + "\"/><parent link=\"" + parent + "\"/><child link=\"" + child + "\"/><axis xyz=\"" +
         axis + "\"/>" + limit + "</joint>";
}

// side: "l" or "r". Axes of roll and yaw joints are mirrored, so that equal joint angles mean
// mirrored arms.
inline std::string arm(const std::string& side, const std::string& last_type,
                       const std::string& fore_iyy) {
  const bool left = side == "l";
  const std::string y = left ? "" : "-";
  const std::string products =
      left ? "ixy=\"0.002\" iyz=\"0.001\"" : "ixy=\"-0.002\" iyz=\"-0.001\"";
  const std::string elbow_axis = last_type == "prismatic" ? "0 0 1" : "0 1 0";
  return link(side + "_shoulder", 1.5, "0 " + y + "0.03 0",
              "ixx=\"0.004\" iyy=\"0.003\" izz=\"0.004\" ixy=\"0\" ixz=\"0\" iyz=\"0\"") +
         link(side + "_upper", 2.0, "0.01 " + y + "0.02 -0.1",
              "ixx=\"0.02\" iyy=\"0.02\" izz=\"0.004\" ixz=\"0.001\" " + products) +
         link(side + "_fore", 2.5, "0 " + y + "0.01 -0.1",
              "ixx=\"0.02\" izz=\"0.005\" ixz=\"0\" iyy=\"" + fore_iyy + "\" " + products) +
         link(side + "_jet", 2.0, "0 0 0.05",
              "ixx=\"0.008\" iyy=\"0.008\" izz=\"0.003\" ixy=\"0\" ixz=\"0\" iyz=\"0\"") +
         joint(side + "_pitch", "revolute", "trunk", side + "_shoulder", "0.1 " + y + "0.15 0.2",
               "0 1 0") +
         joint(side + "_roll", "revolute", side + "_shoulder", side + "_upper", "0 " + y + "0.08 0",
               left ? "1 0 0" : "-1 0 0") +
         joint(side + "_elbow", last_type, side + "_upper", side + "_fore", "0 0 -0.2",
               elbow_axis) +
         joint(side + "_jet_mount", "fixed", side + "_fore", side + "_jet", "0 " + y + "0.05 -0.2",
               "0 0 1", "3.141592653589793 0 0");
}

inline std::string urdf(const std::string& last_type = "revolute",
                        const std::string& fore_iyy = "0.02") {
  std::string text = "<robot name=\"flyer\">" +
                     link("trunk", 22.0, "-0.035 0 0.05",
                          "ixx=\"0.9\" iyy=\"0.8\" izz=\"0.35\" ixy=\"0\" ixz=\"0.01\" iyz=\"0\"");
  for (const std::string side : {"l", "r"}) {
    const std::string y = side == "l" ? "" : "-";
    text += arm(side, last_type, fore_iyy);
    text += link(side + "_back", 2.0, "0 0 0",
                 "ixx=\"0.008\" iyy=\"0.008\" izz=\"0.003\" ixy=\"0\" ixz=\"0\" iyz=\"0\"");
    text += joint(side + "_back_mount", "fixed", "trunk", side + "_back", "-0.12 " + y + "0.1 0.1",
                  "0 0 1", (side == "l" ? "3.0415926535 0 0" : "-3.0415926535 0 0"));
  }
  return text + "</robot>";
}

// Gains, weights and limits of a humanoid with jets of 250 N.
inline void set_controller(FlightSettings& s) {
  s.command_speeds = {0.9375, 0.3125, 0.9375, 0.33, 0.76, 0.76};
  s.reference = {-0.0873, 0.0873, -0.5236, 0.0, 1.5, 0.005, 1.0, 0.05};
  s.gains.momentum_proportional = 1.5;
  s.gains.momentum_derivative = 2.5 * std::sqrt(1.5);
  s.gains.momentum_integral = 10.0;
  s.gains.attitude_proportional = s.gains.torque_integral = 50.0;
  s.gains.attitude_derivative = s.gains.torque_proportional = 2.0 * std::sqrt(50.0);
  s.weights = {10.0, 150.0, 2.5, 10.0, 0.01, 0.1, 1e-4, 1.1e-3};
  s.limits.joint_speed = 0.785;
  s.limits.joint_slope = 10.0;
  s.limits.thrust_slope = 2.0;
  s.limits.torque = 50.0;
  s.limits.torque_rate = 300.0;
  s.failure = {2.0, 1.5707963267948966, 50.0};
}

inline FlightSettings settings() {
  FlightSettings s;
  s.step = 0.008;
  s.duration = 4.0;
  s.initial_free_fall = true;
  set_controller(s);
  for (const std::string side : {"l", "r"}) {
    for (const std::string name : {"pitch", "roll", "elbow"}) s.joints.push_back(side + "_" + name);
  }
  for (const char* frame : {"l_jet", "r_jet", "l_back", "r_back"}) {
    Actuator jet;
    jet.frame = frame;
    jet.thrust_max = 250.0;
    jet.thrust_rate = 200.0;
    s.actuators.push_back(jet);
  }
  s.base_pose(2, 3) = 1.0;
  s.initial_joints = (Eigen::VectorXd(6) << -0.1, 0.2, -0.1, -0.1, 0.2, -0.1).finished();
  s.initial_thrusts.setConstant(4, 100.0);
  s.gains.posture.setConstant(6, 20.0);
  s.limits.joint_lower.setConstant(6, -1.0);
  s.limits.joint_upper.setConstant(6, 1.0);
  s.limits.joint_range_scale.setConstant(6, 1.0);
  s.symmetry_pairs = {{0, 1}, {2, 3}};
  s.groups = {{"left", {"l_pitch", "l_roll", "l_elbow"}, 1.0},
              {"right", {"r_pitch", "r_roll", "r_elbow"}, 2.0}};
  s.contact_points = {{"trunk", Eigen::Vector3d(0.0, 0.0, -0.4)}};
  s.trajectory = {{0.5, 1.5, 1.0, 0.5, 1.0, 0.0, 0.0, 0.0},
                  {1.5, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}};
  return s;
}

inline Model model(const std::string& last_type = "revolute") {
  UrdfOptions options;
  options.joints = settings().joints;
  return load_urdf(urdf(last_type), options);
}

// The same with forearms no body can have: their elbows' entries of the mass matrix are negative.
inline Model unphysical_model() {
  UrdfOptions options;
  options.joints = settings().joints;
  options.as_published = true;
  return load_urdf(urdf("revolute", "-0.25"), options);
}

}  // namespace codesign::dynamics::testing
