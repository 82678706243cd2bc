#include "dynamics/flight/predictive_flight.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "dynamics/disturbance.hpp"
#include "dynamics/flight/flight_samples.hpp"
#include "dynamics/predictive/predictive_controller.hpp"
#include "dynamics/predictive/servo_plant.hpp"
#include "interrupt.hpp"

namespace codesign::dynamics {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

class PredictiveFlight {
 public:
  PredictiveFlight(const Model& model, const FlightSettings& settings, const FlightStart& start);
  FlightLog run();

 private:
  void start();
  FailureReason solve(int k);
  FailureReason advance(int k);
  FailureReason check_limits(const Vector3d& com_error, double angle_error);
  void read_thrusts();
  void log_sample(int k);
  double angle_error(const Vector3d& rpy_reference) const;

  const Model& model_;
  const FlightSettings& settings_;
  bool hovers_;
  RobotState state_;
  std::vector<ThrustState> jets_;
  RobotTerms terms_;  // as the controller knows the robot
  PredictiveController controller_;
  ServoPlant plant_;
  ServoInputs inputs_;
  Gusts gusts_;
  PointHeights heights_;
  FlightMeter meter_;
  Eigen::VectorXd thrust_;
  Stopwatch watch_;
  int plant_steps_;
  double plant_step_;
  FlightLog log_;
};

PredictiveFlight::PredictiveFlight(const Model& model, const FlightSettings& settings,
                                   const FlightStart& start)
    : model_(model),
      settings_(settings),
      hovers_(start.hovers),
      state_(start.state),
      terms_(model, settings.actuators, settings.rotor_inertia),
      controller_(model, settings),
      plant_(model, settings),
      gusts_(settings),
      heights_(model, settings),
      meter_(model.joint_count(), settings.fuel),
      thrust_(start.thrusts) {
  for (const double thrust : start.thrusts) jets_.push_back({thrust, 0.0});
  // Round-off must not add a step.
  plant_steps_ = static_cast<int>(std::ceil(settings.step / settings.servo_plant.step - 1e-6));
  plant_step_ = settings.step / plant_steps_;
}

void PredictiveFlight::start() {
  update_terms(model_, state_, terms_);
  inputs_.set_points = plant_.start(state_, jets_);
  controller_.start(terms_, jets_, inputs_.set_points);
  inputs_.throttles = controller_.throttles();
}

FailureReason PredictiveFlight::solve(int k) {
  update_terms(model_, state_, terms_);
  watch_.lap(log_.profile.terms);
  const QpStatus status = controller_.solve(k, terms_, jets_);
  watch_.lap(log_.profile.momentum_qp);
  inputs_.set_points = controller_.set_points();
  inputs_.throttles = controller_.throttles();
  return status == QpStatus::kSolved ? FailureReason::kNotFailed : FailureReason::kMomentumQp;
}

double PredictiveFlight::angle_error(const Vector3d& rpy_reference) const {
  const Matrix3d R = controller_.builder().world_R_body(plant_.terms());
  const double trace = (rpy_to_rotation(rpy_reference).transpose() * R).trace();
  return std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0));
}

FailureReason PredictiveFlight::check_limits(const Vector3d& com_error, double angle_error) {
  const FailureLimits& limits = settings_.failure;
  log_.max_com_error = std::max(log_.max_com_error, com_error.norm());
  log_.max_attitude_error = std::max(log_.max_attitude_error, angle_error);
  if (com_error.norm() > limits.com_error) return FailureReason::kComError;
  if (angle_error > limits.attitude_error) return FailureReason::kAttitudeError;
  if (state_.velocity.tail(model_.joint_count()).lpNorm<Eigen::Infinity>() > limits.joint_speed) {
    return FailureReason::kJointSpeed;
  }
  return FailureReason::kNotFailed;
}

// The plant steps of one period, measured one by one.
FailureReason PredictiveFlight::advance(int k) {
  for (int i = 0; i < plant_steps_; ++i) {
    const double time = k * settings_.step + i * plant_step_;
    const PulseSum pulse = pulses_at(settings_.pulses, time);
    inputs_.base_force = gusts_.at(time + 0.5 * plant_step_);
    inputs_.com_force = pulse.force;
    inputs_.base_moment = pulse.moment;
    if (!plant_.evaluate(state_, jets_, inputs_)) return FailureReason::kNotFinite;
    read_thrusts();
    const Vector3d com_error = plant_.terms().com - controller_.com_reference(time);
    const Vector3d rpy_reference = controller_.rpy_reference(time);
    const double angle = angle_error(rpy_reference);
    meter_.add(plant_step_, com_error, controller_.body_rpy(plant_.terms()) - rpy_reference, angle,
               plant_.torque(), state_.velocity.tail(model_.joint_count()), thrust_);
    const FailureReason reason = check_limits(com_error, angle);
    if (reason != FailureReason::kNotFailed) return reason;
    if (i == 0) log_sample(k);
    if (!plant_.advance(inputs_, plant_step_, state_, jets_)) return FailureReason::kSingularMass;
  }
  watch_.lap(log_.profile.plant);
  return state_.velocity.allFinite() ? FailureReason::kNotFailed : FailureReason::kNotFinite;
}

void PredictiveFlight::read_thrusts() {
  for (std::size_t j = 0; j < jets_.size(); ++j) thrust_[static_cast<Index>(j)] = jets_[j].thrust;
}

void PredictiveFlight::log_sample(int k) {
  const double time = k * settings_.step;
  const PathPoint path = controller_.path_point(time);
  const Matrix3d R = controller_.builder().world_R_body(plant_.terms());
  const Matrix3d wanted = rpy_to_rotation(controller_.rpy_reference(time));
  FlightLog& log = log_;
  log_state(state_, terms_, k, log);
  log.time(k, 0) = time;
  log.com_reference.row(k) = controller_.com_reference(time).transpose();
  log.com_velocity_reference.row(k) = path.velocity.head<3>().transpose();
  write_rotation(wanted * R.transpose() * state_.base.R, log.rotation_reference, k);
  const Vector3d turning = path.velocity[3] * Vector3d::UnitZ();
  log.angular_velocity_reference.row(k) = (state_.base.R.transpose() * turning).transpose();
  Vector6d error = terms_.momentum;
  error.head<3>() -= model_.total_mass * path.velocity.head<3>();
  error.tail<3>() -= terms_.robot.inertia * turning;
  log.momentum_error.row(k) = error.transpose();
  log.thrust.row(k) = thrust_.transpose();
  for (std::size_t j = 0; j < jets_.size(); ++j) {
    log.thrust_rate_command(k, static_cast<Index>(j)) = jets_[j].thrust_rate;
  }
  log.thrust_command.row(k) = inputs_.throttles.transpose();
  log.joint_velocity_command.row(k) = controller_.set_point_rate().transpose();
  log.torque.row(k) = plant_.torque().transpose();
  log.unmodeled_force.row(k).setZero();
  log.wind.row(k) = (inputs_.base_force + inputs_.com_force).transpose();
  log.clearance(k, 0) = heights_.lowest(terms_);
  const BoxQpResult& qp = controller_.result();
  log.qp_iterations(k, 0) = qp.iterations;
  log.qp_iterations(k, 1) = 0;
  log.active_bounds(k, 0) = static_cast<int>((qp.multipliers.array() != 0.0).count());
  watch_.lap(log.profile.log);
}

FlightLog PredictiveFlight::run() {
  const int samples = sample_count(settings_);
  log_ =
      make_flight_log(samples, model_.joint_count(), static_cast<int>(settings_.actuators.size()));
  log_.step = settings_.step;
  if (!hovers_) set_failure(FailureReason::kNoHover, 0.0, log_);
  start();
  for (int k = 0; k < samples && log_.status == FlightStatus::kCompleted; ++k) {
    check_interrupt();
    FailureReason reason = solve(k);
    const bool last = k + 1 == samples;
    if (reason == FailureReason::kNotFailed && !last) reason = advance(k);
    if (reason == FailureReason::kNotFailed && last) {
      read_thrusts();
      if (plant_.evaluate(state_, jets_, inputs_)) log_sample(k);
    }
    if (reason != FailureReason::kNotFailed) set_failure(reason, k * settings_.step, log_);
  }
  log_.measures = meter_.result();
  return std::move(log_);
}

}  // namespace

FlightLog simulate_predictive_flight(const Model& model, const FlightSettings& settings,
                                     const FlightStart& start) {
  return PredictiveFlight(model, settings, start).run();
}

}  // namespace codesign::dynamics
