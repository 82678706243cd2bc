#include "dynamics/flight_settings.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "dynamics/spatial.hpp"

namespace codesign::dynamics {

namespace {

[[noreturn]] void refuse(const std::string& attribute, const std::string& reason) {
  throw std::invalid_argument("FlightSettings." + attribute + ": " + reason);
}

void require_positive(const std::string& attribute, double value) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    refuse(attribute, "is " + std::to_string(value) + ", must be positive and finite");
  }
}

void require_not_negative(const std::string& attribute, double value) {
  if (!(value >= 0.0) || !std::isfinite(value)) {
    refuse(attribute, "is " + std::to_string(value) + ", must not be negative");
  }
}

void require_size(const std::string& attribute, const Eigen::VectorXd& value, std::size_t size,
                  const std::string& of) {
  if (static_cast<std::size_t>(value.size()) != size) {
    refuse(attribute, "has " + std::to_string(value.size()) + " values, must have one per " + of +
                          " (" + std::to_string(size) + ")");
  }
  if (!value.allFinite()) refuse(attribute, "has a value that is not finite");
}

void require_unique(const std::string& attribute, const std::vector<std::string>& names) {
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (!seen.insert(name).second) refuse(attribute, "names \"" + name + "\" twice");
  }
}

void validate_run(const FlightSettings& s) {
  require_positive("step", s.step);
  require_positive("duration", s.duration);
  constexpr double kMostSamples = 1e6;
  if (s.duration / s.step > kMostSamples) refuse("step", "gives more than a million samples");
  if (std::abs(s.duration / s.step - std::round(s.duration / s.step)) > 1e-6) {
    refuse("duration", "is not a whole number of steps");
  }
  if (s.substeps < 1) refuse("substeps", "must be at least 1");
  if (s.torque_updates < 1) refuse("torque_updates", "must be at least 1");
  require_not_negative("rotation_deadband", s.rotation_deadband);
  if (!s.base_pose.allFinite() || rotation_error(s.base_pose.topLeftCorner<3, 3>()) > 1e-9 ||
      s.base_pose.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    refuse("base_pose", "is not a rigid pose (rotation within 1e-9)");
  }
  for (const CommandWindow& w : s.trajectory) {
    if (!(w.start < w.end)) refuse("trajectory", "has a window whose end is not after its start");
    const Eigen::Matrix<double, 6, 1> signs(w.front, w.left, w.up, w.roll, w.pitch, w.yaw);
    if (!signs.allFinite()) refuse("trajectory", "has a command that is not finite");
  }
}

void validate_actuators(const FlightSettings& s) {
  std::vector<std::string> frames;
  for (const Actuator& actuator : s.actuators) {
    const std::string name = "actuators[" + actuator.frame + "].";
    frames.push_back(actuator.frame);
    if (std::abs(actuator.axis.norm() - 1.0) > 1e-9) refuse(name + "axis", "is no unit vector");
    if (!std::isfinite(actuator.reaction)) refuse(name + "reaction", "is not finite");
    require_not_negative(name + "thrust_min", actuator.thrust_min);
    require_positive(name + "thrust_max", actuator.thrust_max);
    require_positive(name + "thrust_rate", actuator.thrust_rate);
    if (actuator.thrust_min >= actuator.thrust_max) {
      refuse(name + "thrust_min", "is not below thrust_max");
    }
    if (const auto* lag = std::get_if<FirstOrderLag>(&actuator.dynamics)) {
      require_positive(name + "dynamics.time", lag->time);
    }
  }
  require_unique("actuators", frames);
}

void validate_joint_limits(const FlightSettings& s) {
  const std::size_t joints = s.joints.size();
  require_size("gains.posture", s.gains.posture, joints, "joint");
  if (s.limits.joint_lower.size() > 0 || s.limits.joint_upper.size() > 0) {
    require_size("limits.joint_lower", s.limits.joint_lower, joints, "joint");
    require_size("limits.joint_upper", s.limits.joint_upper, joints, "joint");
  }
  require_size("limits.joint_range_scale", s.limits.joint_range_scale, joints, "joint");
  for (Eigen::Index i = 0; i < s.limits.joint_lower.size(); ++i) {
    if (!(s.limits.joint_lower[i] * s.limits.joint_range_scale[i] <
          s.limits.joint_upper[i] * s.limits.joint_range_scale[i])) {
      refuse("limits",
             "the range of joint \"" + s.joints[static_cast<std::size_t>(i)] + "\" is empty");
    }
  }
}

void validate_robot(const FlightSettings& s) {
  require_unique("joints", s.joints);
  validate_actuators(s);
  if (s.actuators.empty()) refuse("actuators", "is empty");
  const std::size_t joints = s.joints.size();
  const std::size_t jets = s.actuators.size();
  require_size("initial_joints", s.initial_joints, joints, "joint");
  require_size("initial_thrusts", s.initial_thrusts, jets, "jet");
  if (s.controller == Controller::kMomentumQp) validate_joint_limits(s);
  for (const auto& [a, b] : s.symmetry_pairs) {
    const int count = static_cast<int>(jets);
    if (a == b || std::min(a, b) < 0 || std::max(a, b) >= count) {
      refuse("symmetry_pairs",
             "must name two different jets by index 0 … " + std::to_string(count - 1));
    }
  }
  for (const JointGroup& group : s.groups) {
    for (const std::string& name : group.joints) {
      if (std::find(s.joints.begin(), s.joints.end(), name) == s.joints.end()) {
        refuse("groups", "\"" + group.name + "\" names \"" + name + "\", not one of the joints");
      }
    }
    if (group.joints.empty()) refuse("groups", "\"" + group.name + "\" has no joint");
  }
}

void validate_control(const FlightSettings& s) {
  require_positive("reference.com_time", s.reference.com_time);
  require_positive("reference.jerk_time", s.reference.jerk_time);
  require_positive("reference.angular_velocity_time", s.reference.angular_velocity_time);
  require_not_negative("reference.rotation_gain", s.reference.rotation_gain);
  if (!(s.reference.roll_min <= s.reference.roll_max) ||
      !(s.reference.pitch_min <= s.reference.pitch_max)) {
    refuse("reference", "a lower angle limit is above the upper one");
  }
  require_not_negative("gains.observer", s.gains.observer);
  if (s.gains.observer * s.step >= 1.0) refuse("gains.observer", "is not below 1 / step");
  require_positive("gains.momentum_integral", s.gains.momentum_integral);
  require_not_negative("weights.momentum", s.weights.momentum);
  require_not_negative("weights.constant_inertia", s.weights.constant_inertia);
  require_not_negative("weights.posture", s.weights.posture);
  require_not_negative("weights.joint_velocity", s.weights.joint_velocity);
  require_not_negative("weights.thrust_rate", s.weights.thrust_rate);
  require_not_negative("weights.thrust_symmetry", s.weights.thrust_symmetry);
  require_positive("weights.regularization", s.weights.regularization);
  require_positive("weights.torque", s.weights.torque);
  require_positive("limits.joint_speed", s.limits.joint_speed);
  require_positive("limits.joint_slope", s.limits.joint_slope);
  require_positive("limits.thrust_slope", s.limits.thrust_slope);
  require_positive("limits.torque", s.limits.torque);
  require_positive("limits.torque_rate", s.limits.torque_rate);
}

void validate_failure(const FlightSettings& s) {
  require_positive("failure.com_error", s.failure.com_error);
  require_positive("failure.attitude_error", s.failure.attitude_error);
  require_positive("failure.joint_speed", s.failure.joint_speed);
}

void require_per_joint(const std::string& attribute, const Eigen::VectorXd& value,
                       const FlightSettings& s) {
  if (value.size() == 0) return;
  require_size(attribute, value, s.joints.size(), "joint");
  if (value.minCoeff() < 0.0) refuse(attribute, "has a negative value");
}

void require_multiple(const std::string& attribute, double value, double period) {
  require_not_negative(attribute, value);
  if (std::abs(value / period - std::round(value / period)) > 1e-6) {
    refuse(attribute, "is not a whole number of periods of " + std::to_string(period) + " s");
  }
}

void validate_plant(const FlightSettings& s) {
  if (s.posture_reference.size() > 0) {
    require_size("posture_reference", s.posture_reference, s.joints.size(), "joint");
  }
  if (s.trim && s.initial_free_fall) {
    refuse("trim", "a robot that starts in hover does not fall: set initial_free_fall to false");
  }
  require_per_joint("rotor_inertia", s.rotor_inertia, s);
  require_per_joint("friction.viscous", s.friction.viscous, s);
  require_per_joint("friction.coulomb", s.friction.coulomb, s);
  require_positive("friction.slip_speed", s.friction.slip_speed);
  require_multiple("delays.momentum", s.delays.momentum, s.step);
  require_multiple("delays.torque", s.delays.torque, s.step / s.torque_updates);
  require_not_negative("delays.torque_lag", s.delays.torque_lag);
  require_positive("air_density", s.air_density);
  for (const DragArea& area : s.drag) {
    require_not_negative("drag[" + area.frame + "].area", area.area);
    if (!area.position.allFinite()) refuse("drag", "has a position that is not finite");
  }
  if (s.tank) {
    require_positive("tank.fuel", s.tank->fuel);
    require_not_negative("tank.consumption", s.tank->consumption);
    if (!s.tank->position.allFinite()) refuse("tank.position", "is not finite");
  }
}

void validate_disturbances(const FlightSettings& s) {
  const Disturbances& d = s.disturbances;
  // Random numbers stay within six deviations: a larger deviation could turn a scale negative.
  constexpr double kMostDeviation = 0.15;
  require_positive("disturbances.gust_time", d.gust_time);
  require_positive("disturbances.mass_scale", d.mass_scale);
  for (const double deviation : {d.mass_deviation, d.thrust_deviation}) {
    if (!(deviation >= 0.0 && deviation <= kMostDeviation)) {
      refuse("disturbances", "mass_deviation and thrust_deviation must be within 0 … 0.15");
    }
  }
  if (d.thrust_scale.size() > 0) {
    require_size("disturbances.thrust_scale", d.thrust_scale, s.actuators.size(), "jet");
  }
  if (!d.wind_velocity.allFinite()) refuse("disturbances.wind_velocity", "is not finite");
  if (!d.wind_velocity.isZero(0.0) && s.drag.empty()) {
    refuse("disturbances.wind_velocity", "acts on drag areas, and there are none");
  }
  if (!d.wind_force.allFinite() || !d.gust_deviation.allFinite() ||
      d.gust_deviation.minCoeff() < 0.0) {
    refuse("disturbances", "wind_force and gust_deviation must be finite, the latter not negative");
  }
}

void validate_predictive(const FlightSettings& s) {
  if (s.predictive.period != s.step) refuse("predictive.period", "is not `step`");
  if (!s.trajectory.empty()) {
    refuse("trajectory", "the predictive controller flies way-points, not commands");
  }
  const bool friction = s.friction.viscous.size() > 0 || s.friction.coulomb.size() > 0;
  const bool late = s.delays.momentum > 0.0 || s.delays.torque > 0.0 || s.delays.torque_lag > 0.0;
  if (friction || late || !s.drag.empty() || s.tank) {
    refuse("controller", "predictive flights have no friction, delays, drag and tank");
  }
  validate(s.predictive);
  validate(s.servo_plant, static_cast<Eigen::Index>(s.joints.size()));
}

}  // namespace

void validate(const FlightSettings& settings) {
  validate_run(settings);
  validate_robot(settings);
  if (settings.controller == Controller::kMomentumQp) validate_control(settings);
  validate_plant(settings);
  validate_disturbances(settings);
  validate_failure(settings);
  validate(settings.pulses);
  if (settings.controller == Controller::kPredictive) validate_predictive(settings);
}

int sample_count(const FlightSettings& settings) {
  return static_cast<int>(std::lround(settings.duration / settings.step)) + 1;
}

}  // namespace codesign::dynamics
