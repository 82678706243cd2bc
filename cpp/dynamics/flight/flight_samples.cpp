#include "dynamics/flight/flight_samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace codesign::dynamics {

PointHeights::PointHeights(const Model& model, const FlightSettings& settings)
    : ground_height_(settings.ground_height) {
  for (const ContactPoint& point : settings.contact_points) {
    const Frame& frame = model.frames[static_cast<std::size_t>(frame_index(model, point.frame))];
    points_.push_back({frame.body, frame.body_T_frame.p + frame.body_T_frame.R * point.position});
  }
}

double PointHeights::lowest(const RobotTerms& terms) const {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Point& point : points_) {
    const BodyPose& body = terms.kin.bodies[static_cast<std::size_t>(point.body)];
    lowest = std::min(lowest, body.p.z() + body.R.row(2).dot(point.position));
  }
  return terms.kin.base_position.z() + lowest - ground_height_;
}

void write_rotation(const Eigen::Matrix3d& R, History& history, int k) {
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(history.row(k).data()) = R;
}

Eigen::Matrix3d read_rotation(const History& history, int k) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(history.row(k).data());
}

PulseSum pulses_at(const std::vector<Pulse>& pulses, double time) {
  constexpr double kRounding = 1e-9;  // [s]
  PulseSum sum;
  for (const Pulse& pulse : pulses) {
    const double since = time + kRounding - pulse.start;
    if (since < 0.0 || since >= pulse.duration) continue;
    sum.force += pulse.force;
    sum.moment += pulse.moment;
  }
  return sum;
}

void log_state(const RobotState& state, const RobotTerms& terms, int k, FlightLog& log) {
  log.samples = k + 1;
  log.base_position.row(k) = state.base.p.transpose();
  write_rotation(state.base.R, log.base_rotation, k);
  log.joint_positions.row(k) = state.joints.transpose();
  log.velocity.row(k) = state.velocity.transpose();
  log.com.row(k) = terms.com.transpose();
  log.momentum.row(k) = terms.momentum.transpose();
}

void set_failure(FailureReason reason, double time, FlightLog& log) {
  log.status = FlightStatus::kFailed;
  log.failure_reason = reason;
  log.failure_time = time;
  if (reason == FailureReason::kMomentumQp || reason == FailureReason::kTorqueQp) {
    ++log.qp_failures;
  }
}

double hover_margin(const std::vector<Actuator>& actuators,
                    const Eigen::Ref<const Eigen::VectorXd>& thrusts) {
  double margin = 1.0;
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    const double share = thrusts[static_cast<Eigen::Index>(i)] / actuators[i].thrust_max;
    margin = std::min(margin, 1.0 - share);
  }
  return margin;
}

}  // namespace codesign::dynamics
