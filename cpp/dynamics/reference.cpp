#include "dynamics/reference.hpp"

#include <algorithm>
#include <cmath>

namespace codesign::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Command command_at(const std::vector<CommandWindow>& trajectory, int index, double step) {
  // Boundaries are whole multiples of the step up to rounding; a sample on one is outside.
  constexpr double kRounding = 1e-6;
  Command command;
  for (const CommandWindow& window : trajectory) {
    const double sample = static_cast<double>(index);
    if (sample > window.start / step + kRounding && sample < window.end / step - kRounding) {
      command = {window.front, window.left, window.up, window.roll, window.pitch, window.yaw};
    }
  }
  return command;
}

ReferenceGenerator::ReferenceGenerator(const FlightSettings& settings, const Vector3d& com,
                                       const Matrix3d& base_rotation)
    : settings_(settings.reference),
      speeds_(settings.command_speeds),
      step_(settings.step),
      raw_position_(com),
      raw_rpy_(rotation_to_rpy(base_rotation)),
      com_filter_(settings_.com_time, step_),
      jerk_filter_(settings_.jerk_time, step_),
      angular_filter_(settings_.angular_velocity_time, step_) {
  if (!settings.trim) return;
  // Where a robot hovers with its base tilted, it may stay so.
  settings_.roll_min = std::min(settings_.roll_min, raw_rpy_.x());
  settings_.roll_max = std::max(settings_.roll_max, raw_rpy_.x());
  settings_.pitch_min = std::min(settings_.pitch_min, raw_rpy_.y());
  settings_.pitch_max = std::max(settings_.pitch_max, raw_rpy_.y());
}

const Reference& ReferenceGenerator::update(const Command& command) {
  raw_rpy_ += step_ * Vector3d(command.roll * speeds_.roll, command.pitch * speeds_.pitch,
                               command.yaw * speeds_.yaw);
  raw_rpy_.x() = std::clamp(raw_rpy_.x(), settings_.roll_min, settings_.roll_max);
  raw_rpy_.y() = std::clamp(raw_rpy_.y(), settings_.pitch_min, settings_.pitch_max);
  const Vector3d move = step_ * Vector3d(command.front * speeds_.front, command.left * speeds_.left,
                                         command.up * speeds_.up);
  raw_position_ += rpy_to_rotation({0.0, 0.0, raw_rpy_.z()}) * move;
  const Matrix3d raw_rotation = rpy_to_rotation(raw_rpy_);

  const MotionFilter::Output& com = com_filter_.update(raw_position_);
  reference_.position = com.value;
  reference_.velocity = com.velocity;
  reference_.acceleration = com.acceleration;
  reference_.jerk = jerk_filter_.update(com.acceleration).velocity;

  if (!started_) {
    started_ = true;
    smooth_rotation_ = raw_rotation;
  }
  const Matrix3d R = smooth_rotation_;
  const Vector3d rate = -settings_.rotation_gain * skew_part(raw_rotation.transpose() * R);
  reference_.rotation = R;
  const MotionFilter::Output& angular = angular_filter_.update(rate);
  reference_.angular_velocity = angular.value;
  reference_.angular_acceleration = angular.velocity;
  reference_.angular_jerk = angular.acceleration;
  // The second term pulls the explicit step back to the orthogonal matrices.
  smooth_rotation_ += step_ * (R * skew(rate) + (Matrix3d::Identity() - R * R.transpose()) * R);
  return reference_;
}

Reference path_reference(const Path& path, double time, const Pose& start) {
  const PathPoint point = path.at(time);
  Reference reference;
  reference.position = start.p + point.value.head<3>();
  reference.velocity = point.velocity.head<3>();
  reference.acceleration = point.acceleration.head<3>();
  reference.jerk = point.jerk.head<3>();
  reference.rotation = rpy_to_rotation({0.0, 0.0, point.value[3]}) * start.R;
  const Vector3d vertical = start.R.transpose().col(2);  // in base axes, also when turned
  reference.angular_velocity = point.velocity[3] * vertical;
  reference.angular_acceleration = point.acceleration[3] * vertical;
  reference.angular_jerk = point.jerk[3] * vertical;
  return reference;
}

}  // namespace codesign::dynamics
