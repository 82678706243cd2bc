#include "dynamics/flight.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "dynamics/disturbance.hpp"
#include "dynamics/momentum_controller.hpp"
#include "dynamics/objectives.hpp"
#include "dynamics/plant.hpp"
#include "dynamics/torque_controller.hpp"
#include "interrupt.hpp"

namespace codesign::dynamics {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

void require_fit(const Model& model, const FlightSettings& settings) {
  validate(settings);
  if (model.fixed_base) throw std::invalid_argument("simulate_flight: the model's base is fixed");
  bool same = model.joints.size() == settings.joints.size();
  for (std::size_t i = 0; same && i < model.joints.size(); ++i) {
    same = model.joints[i].name == settings.joints[i];
  }
  if (!same) {
    throw std::invalid_argument(
        "simulate_flight: the model's joints are not those of the settings; load it with "
        "joints=settings.joints");
  }
}

// A contact point resolved to its frame.
struct WatchedPoint {
  int frame;
  Vector3d position;
};

// Adds the time since the last call to one phase after the other.
class Stopwatch {
 public:
  void lap(double& phase) {
    const Clock::time_point now = Clock::now();
    phase += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

// Everything the loop carries from step to step. The member functions are the items of one step.
class Flight {
 public:
  Flight(const Model& model, const FlightSettings& settings);
  FlightLog run();

 private:
  bool advance_plant(int k);
  void advance_jets(int k);
  bool update_dynamics();
  FailureReason control(int k);
  FailureReason check_limits();
  void command_jets();
  double lowest_point() const;
  void log_sample(int k);
  void fail(FailureReason reason, int k);

  const Model& model_;
  const FlightSettings& settings_;
  RobotState state_;
  RobotTerms terms_;
  JointSpace joint_space_;
  Plant plant_;
  PlantInputs inputs_;
  Gusts gusts_;
  std::vector<WatchedPoint> points_;
  std::vector<ThrustState> jets_;
  Eigen::VectorXd thrust_, thrust_rate_, command_, joint_velocity_, force_, joint_force_;
  ControllerOrigin origin_;
  ReferenceGenerator reference_generator_;
  Reference reference_;
  MomentumTask task_;
  MomentumQp qp_;
  BoxQpSolver qp_solver_;
  TorqueController torque_controller_;
  double com_error_ = 0.0, attitude_error_ = 0.0;
  FlightLog log_;
  Stopwatch watch_;
};

RobotState initial_state(const FlightSettings& settings) {
  RobotState state;
  state.base.p = settings.base_pose.topRightCorner<3, 1>();
  state.base.R = settings.base_pose.topLeftCorner<3, 3>();
  state.joints = settings.initial_joints;
  state.velocity.setZero(kBaseDofs + settings.initial_joints.size());
  return state;
}

Flight::Flight(const Model& model, const FlightSettings& settings)
    : model_(model),
      settings_(settings),
      state_(initial_state(settings)),
      terms_(model, settings.actuators),
      joint_space_(model.joint_count()),
      plant_(model, settings),
      gusts_(settings),
      thrust_(settings.initial_thrusts),
      reference_generator_(settings, Vector3d::Zero(), Matrix3d::Identity()),
      task_(static_cast<int>(settings.actuators.size()), model.joint_count()),
      qp_(static_cast<int>(settings.actuators.size()) + model.joint_count()),
      qp_solver_(qp_.g.size() > 0 ? static_cast<int>(qp_.g.size()) : 1),
      torque_controller_(settings) {
  const auto jets = static_cast<Index>(settings.actuators.size());
  const Index joints = model.joint_count();
  inputs_ = {Eigen::VectorXd::Zero(joints), Eigen::VectorXd::Zero(jets), Vector3d::Zero()};
  for (Eigen::VectorXd* v : {&thrust_rate_, &command_}) v->setZero(jets);
  for (Eigen::VectorXd* v : {&joint_velocity_, &joint_force_}) v->setZero(joints);
  force_.setZero(model.dofs());
  for (const ContactPoint& point : settings.contact_points) {
    points_.push_back({frame_index(model, point.frame), point.position});
  }
  for (const double thrust : settings.initial_thrusts) jets_.push_back({thrust, 0.0});
}

// Item 1: the state moves on under the torques and thrusts of the last step.
bool Flight::advance_plant(int k) {
  if (k == 0 && !settings_.initial_free_fall) return true;
  inputs_.base_force = gusts_.next();
  return plant_.advance(terms_, joint_space_, inputs_, state_);
}

// Item 2: the thrusts move on under the commands of the last step.
void Flight::advance_jets(int k) {
  if (k == 0) return;
  for (std::size_t i = 0; i < jets_.size(); ++i) {
    const auto jet = static_cast<Index>(i);
    jets_[i] = advance(settings_.actuators[i], jets_[i], command_[jet], settings_.step);
    thrust_[jet] = jets_[i].thrust;
  }
}

bool Flight::update_dynamics() {
  update_terms(model_, state_, terms_);
  return joint_space_.set_mass_matrix(terms_.mass_matrix);
}

// Items 3 to 5: references, momentum QP, torques.
FailureReason Flight::control(int k) {
  if (k == 0) {
    origin_ = controller_origin(state_, terms_);
    reference_generator_ = ReferenceGenerator(settings_, terms_.com, state_.base.R);
  }
  reference_ = reference_generator_.update(command_at(settings_.trajectory, k, settings_.step));

  build_momentum_task(model_, settings_, origin_, state_, terms_, thrust_, reference_, task_);
  build_momentum_qp(settings_, origin_, task_, state_, thrust_, qp_);
  watch_.lap(log_.profile.task);
  const BoxQpResult& solution = qp_solver_.solve(qp_.H, qp_.g, qp_.lower, qp_.upper);
  watch_.lap(log_.profile.momentum_qp);
  if (solution.status != QpStatus::kSolved) return FailureReason::kMomentumQp;
  thrust_rate_ = solution.x.head(thrust_.size());
  joint_velocity_ = solution.x.tail(joint_velocity_.size());
  command_jets();

  force_ = -terms_.bias;
  add_jet_forces(model_, terms_, thrust_, force_);
  joint_space_.reduce_force(force_, joint_force_);
  if (torque_controller_.update(joint_space_, joint_force_,
                                state_.velocity.tail(model_.joint_count()),
                                joint_velocity_) != QpStatus::kSolved) {
    return FailureReason::kTorqueQp;
  }
  inputs_.torque = torque_controller_.torque();
  inputs_.thrust = thrust_;
  watch_.lap(log_.profile.torque);
  return FailureReason::kNotFailed;
}

void Flight::command_jets() {
  for (std::size_t i = 0; i < jets_.size(); ++i) {
    const auto jet = static_cast<Index>(i);
    command_[jet] = command_for_rate(settings_.actuators[i], jets_[i], thrust_rate_[jet]);
  }
}

FailureReason Flight::check_limits() {
  const FailureLimits& limits = settings_.failure;
  com_error_ = (terms_.com - reference_.position).norm();
  const double trace = (reference_.rotation.transpose() * state_.base.R).trace();
  attitude_error_ = std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0));
  if (com_error_ > limits.com_error) return FailureReason::kComError;
  if (attitude_error_ > limits.attitude_error) return FailureReason::kAttitudeError;
  if (state_.velocity.tail(model_.joint_count()).lpNorm<Eigen::Infinity>() > limits.joint_speed) {
    return FailureReason::kJointSpeed;
  }
  return FailureReason::kNotFailed;
}

double Flight::lowest_point() const {
  double lowest = std::numeric_limits<double>::infinity();
  for (const WatchedPoint& point : points_) {
    const Frame& frame = model_.frames[static_cast<std::size_t>(point.frame)];
    const BodyPose& body = terms_.kin.bodies[static_cast<std::size_t>(frame.body)];
    const Vector3d on_body = frame.body_T_frame.p + frame.body_T_frame.R * point.position;
    lowest = std::min(lowest, body.p.z() + body.R.row(2).dot(on_body));
  }
  return terms_.kin.base_position.z() + lowest - settings_.ground_height;
}

using RowMajorRotation = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

void write_rotation(const Matrix3d& R, History& history, int k) {
  Eigen::Map<RowMajorRotation>(history.row(k).data()) = R;
}

void Flight::log_sample(int k) {
  FlightLog& log = log_;
  log.samples = k + 1;
  log.time(k, 0) = k * settings_.step;
  log.base_position.row(k) = state_.base.p.transpose();
  write_rotation(state_.base.R, log.base_rotation, k);
  log.joint_positions.row(k) = state_.joints.transpose();
  log.velocity.row(k) = state_.velocity.transpose();
  log.com.row(k) = terms_.com.transpose();
  log.com_reference.row(k) = reference_.position.transpose();
  log.com_velocity_reference.row(k) = reference_.velocity.transpose();
  write_rotation(reference_.rotation, log.rotation_reference, k);
  log.angular_velocity_reference.row(k) = reference_.angular_velocity.transpose();
  const double mass = terms_.inertia.subtrees[0].mass;
  Vector6d error = terms_.momentum;
  error.head<3>() -= mass * reference_.velocity;
  error.tail<3>() -= reference_.rotation * (origin_.base_inertia * reference_.angular_velocity);
  log.momentum.row(k) = terms_.momentum.transpose();
  log.momentum_error.row(k) = error.transpose();
  log.thrust.row(k) = thrust_.transpose();
  log.thrust_rate_command.row(k) = thrust_rate_.transpose();
  log.thrust_command.row(k) = command_.transpose();
  log.joint_velocity_command.row(k) = joint_velocity_.transpose();
  log.torque.row(k) = inputs_.torque.transpose();
  log.wind.row(k) = inputs_.base_force.transpose();
  log.clearance(k, 0) = lowest_point();
  const BoxQpResult& qp = qp_solver_.result();
  log.qp_iterations(k, 0) = qp.iterations;
  log.qp_iterations(k, 1) = torque_controller_.iterations();
  log.active_bounds(k, 0) = static_cast<int>((qp.multipliers.array() != 0.0).count());
  log.max_com_error = std::max(log.max_com_error, com_error_);
  log.max_attitude_error = std::max(log.max_attitude_error, attitude_error_);
}

void Flight::fail(FailureReason reason, int k) {
  log_.status = FlightStatus::kFailed;
  log_.failure_reason = reason;
  log_.failure_time = k * settings_.step;
  if (reason == FailureReason::kMomentumQp || reason == FailureReason::kTorqueQp) {
    ++log_.qp_failures;
  }
}

FlightLog Flight::run() {
  const int samples = sample_count(settings_);
  log_ =
      make_flight_log(samples, model_.joint_count(), static_cast<int>(settings_.actuators.size()));
  log_.step = settings_.step;
  if (!update_dynamics()) fail(FailureReason::kSingularMass, 0);
  watch_ = {};
  for (int k = 0; k < samples && log_.status == FlightStatus::kCompleted; ++k) {
    check_interrupt();
    FailureReason reason = FailureReason::kNotFailed;
    if (!advance_plant(k)) reason = FailureReason::kSingularMass;
    advance_jets(k);
    watch_.lap(log_.profile.plant);
    if (!state_.velocity.allFinite() || !state_.joints.allFinite() || !thrust_.allFinite()) {
      reason = FailureReason::kNotFinite;
    }
    if (reason == FailureReason::kNotFailed && !update_dynamics())
      reason = FailureReason::kSingularMass;
    watch_.lap(log_.profile.terms);
    if (reason == FailureReason::kNotFailed) reason = control(k);
    if (reason == FailureReason::kNotFailed) {
      reason = check_limits();
      log_sample(k);
      watch_.lap(log_.profile.log);
    }
    if (reason != FailureReason::kNotFailed) fail(reason, k);
  }
  return std::move(log_);
}

void summarize(const Model& model, const FlightSettings& settings, FlightLog& log) {
  if (log.samples == 0) return;
  log.min_thrust = log.thrust.minCoeff();
  log.max_thrust = log.thrust.maxCoeff();
  log.max_torque = log.torque.lpNorm<Eigen::Infinity>();
  log.max_joint_speed = log.velocity.rightCols(model.joint_count()).lpNorm<Eigen::Infinity>();
  log.min_clearance = log.clearance.minCoeff();
  log.ground_touched = log.min_clearance < 0.0;
  log.total_qp_iterations = log.qp_iterations.cast<long>().sum();
  compute_objectives(settings, log);
}

RobotState logged_state(const FlightLog& log, int k) {
  RobotState state;
  state.base.p = log.base_position.row(k).transpose();
  state.base.R = Eigen::Map<const RowMajorRotation>(log.base_rotation.row(k).data());
  state.joints = log.joint_positions.row(k).transpose();
  state.velocity = log.velocity.row(k).transpose();
  return state;
}

}  // namespace

FlightLog simulate_flight(const Model& model, const FlightSettings& settings) {
  require_fit(model, settings);
  FlightLog log = Flight(model, settings).run();
  if (log.samples < log.time.rows()) truncate(log);
  summarize(model, settings, log);
  return log;
}

std::vector<MomentumQp> momentum_qps(const Model& model, const FlightSettings& settings,
                                     const FlightLog& log, int every) {
  require_fit(model, settings);
  if (every < 1) throw std::invalid_argument("momentum_qps: every must be at least 1");
  if (log.velocity.cols() != model.dofs() || log.step != settings.step) {
    throw std::invalid_argument("momentum_qps: the log is not of this model and these settings");
  }
  std::vector<MomentumQp> qps;
  if (log.samples == 0) return qps;
  const int jets = static_cast<int>(settings.actuators.size());
  RobotTerms terms(model, settings.actuators);
  update_terms(model, logged_state(log, 0), terms);
  const ControllerOrigin origin = controller_origin(logged_state(log, 0), terms);
  ReferenceGenerator generator(settings, terms.com, logged_state(log, 0).base.R);
  MomentumTask task(jets, model.joint_count());
  MomentumQp qp(jets + model.joint_count());
  for (int k = 0; k < log.samples; ++k) {
    check_interrupt();
    const Reference& reference =
        generator.update(command_at(settings.trajectory, k, settings.step));
    if (k % every != 0) continue;
    const RobotState state = logged_state(log, k);
    const Eigen::VectorXd thrust = log.thrust.row(k).transpose();
    update_terms(model, state, terms);
    build_momentum_task(model, settings, origin, state, terms, thrust, reference, task);
    build_momentum_qp(settings, origin, task, state, thrust, qp);
    qps.push_back(qp);
  }
  return qps;
}

}  // namespace codesign::dynamics
