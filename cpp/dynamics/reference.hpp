#pragma once

#include <Eigen/Core>

#include "dynamics/flight_settings.hpp"
#include "dynamics/motion_filter.hpp"
#include "dynamics/spatial.hpp"
#include "dynamics/waypoints.hpp"

namespace codesign::dynamics {

// What the controller tracks at one sample: center of mass with three derivatives in world axes,
// rotation of the base, its angular velocity with two derivatives in base axes.
struct Reference {
  Eigen::Vector3d position, velocity, acceleration, jerk;
  Eigen::Matrix3d rotation;
  Eigen::Vector3d angular_velocity, angular_acceleration, angular_jerk;
};

// Signs of a pilot's command at one sample (CommandWindow).
struct Command {
  double front = 0.0, left = 0.0, up = 0.0, roll = 0.0, pitch = 0.0, yaw = 0.0;
};

// Command at sample `index` (time = index · step): windows are open intervals, later ones win.
Command command_at(const std::vector<CommandWindow>& trajectory, int index, double step);

// Integrates commands into a raw path, then smooths it: minimum-jerk filters for the center of
// mass, a first-order follower on SO(3) and a filter of its angular velocity for the rotation.
class ReferenceGenerator {
 public:
  // Starts at rest at this center of mass and base rotation.
  ReferenceGenerator(const FlightSettings& settings, const Eigen::Vector3d& com,
                     const Eigen::Matrix3d& base_rotation);

  const Reference& update(const Command& command);

 private:
  ReferenceSettings settings_;
  CommandSpeeds speeds_;
  double step_;
  Eigen::Vector3d raw_position_, raw_rpy_;
  bool started_ = false;
  Eigen::Matrix3d smooth_rotation_;
  MotionFilter com_filter_, jerk_filter_, angular_filter_;
  Reference reference_;
};

// What the path asks for at a time; start: the base's rotation and the center of mass that it
// counts from. The base turns about the world's vertical.
Reference path_reference(const Path& path, double time, const Pose& start);

}  // namespace codesign::dynamics
