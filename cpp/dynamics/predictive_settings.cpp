#include "dynamics/predictive_settings.hpp"

#include <cmath>
#include <set>
#include <stdexcept>

namespace codesign::dynamics {

namespace {

void require(bool holds, const std::string& reason) {
  if (!holds) throw std::invalid_argument("FlightSettings." + reason);
}

bool not_negative(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return values.allFinite() && (values.array() >= 0.0).all();
}

}  // namespace

void validate(const PredictiveSettings& s) {
  require(s.period > 0.0 && std::isfinite(s.period), "predictive.period: must be positive");
  require(s.throttle_every >= 1, "predictive.throttle_every: must be at least 1");
  require(s.small_steps >= 1, "predictive.small_steps: must be at least 1");
  require(s.large_steps >= 0, "predictive.large_steps: must not be negative");
  require(std::isfinite(s.large_step) && s.large_step >= s.period * s.small_steps * (1.0 - 1e-9),
          "predictive.large_step: the small steps do not fit into it");
  require(s.small_steps > 1 || std::abs(s.large_step - s.period) < 1e-9 * s.period,
          "predictive.small_steps: one small step is a large one, so the period must be too");
  require(s.control_steps >= s.small_steps && s.control_steps <= s.small_steps + s.large_steps,
          "predictive.control_steps: must be between small_steps and the number of steps");
  require(!s.body.empty(), "predictive.body: names no link");
  require(std::set<std::string>(s.joints.begin(), s.joints.end()).size() == s.joints.size(),
          "predictive.joints: names a joint twice");
  require(s.joint_speed > 0.0, "predictive.joint_speed: must be positive");
  const PredictiveWeights& w = s.weights;
  for (const Eigen::Vector3d& v : {w.com, w.com_integral, w.linear_momentum, w.attitude,
                                   w.attitude_integral, w.angular_momentum}) {
    require(not_negative(v), "predictive.weights: a weight is negative or not finite");
  }
  require(w.joint_displacement > 0.0 && std::isfinite(w.joint_displacement),
          "predictive.weights.joint_displacement: must be positive");
  require(w.posture >= 0.0 && std::isfinite(w.posture),
          "predictive.weights.posture: must not be negative");
  require(w.throttle_first > 0.0 && std::isfinite(w.throttle_first) && w.throttle_change > 0.0 &&
              std::isfinite(w.throttle_change),
          "predictive.weights: throttle_first and throttle_change must be positive");
}

void validate(const ServoPlantSettings& s, Eigen::Index joints) {
  for (const Eigen::VectorXd* v : {&s.servo.stiffness, &s.servo.damping_ratio, &s.servo.passive}) {
    require(v->size() == joints, "plant.servo: needs one value per joint (" +
                                     std::to_string(joints) + ") in each of its vectors");
    require(not_negative(*v), "plant.servo: a value is negative or not finite");
  }
  require((s.servo.stiffness.array() > 0.0).all(), "plant.servo.stiffness: must be positive");
  require(s.step > 0.0 && std::isfinite(s.step), "plant.step: must be positive");
}

void validate(const std::vector<Pulse>& pulses) {
  for (const Pulse& pulse : pulses) {
    require(pulse.duration > 0.0 && std::isfinite(pulse.duration) && pulse.start >= 0.0 &&
                std::isfinite(pulse.start),
            "pulses: start must not be negative, duration must be positive");
    require(pulse.force.allFinite() && pulse.moment.allFinite(),
            "pulses: a force or moment is not finite");
  }
}

}  // namespace codesign::dynamics
