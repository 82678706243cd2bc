#include "dynamics/flight/flight.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "dynamics/disturbance.hpp"
#include "dynamics/drives.hpp"
#include "dynamics/flight/flight_samples.hpp"
#include "dynamics/flight/flight_start.hpp"
#include "dynamics/flight/objectives.hpp"
#include "dynamics/flight/predictive_flight.hpp"
#include "dynamics/momentum_controller.hpp"
#include "dynamics/momentum_observer.hpp"
#include "dynamics/paired/jet_mounts.hpp"
#include "dynamics/plant.hpp"
#include "dynamics/torque_controller.hpp"
#include "interrupt.hpp"

namespace codesign::dynamics {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// Everything the loop carries from step to step. The member functions are the items of one step.
class Flight {
 public:
  Flight(const Model& model, const FlightSettings& settings, const FlightStart& start,
         const OwnPlant& own_plant);
  FlightLog run();

 private:
  FailureReason advance_plant(int k);
  bool move(bool held);
  void advance_jets(int k);
  bool update_dynamics();
  FailureReason control(int k);
  FailureReason update_torque(bool held);
  FailureReason check_limits();
  void command_jets();
  void log_sample(int k);
  void measure(int k);

  const Model& model_;
  const FlightSettings& settings_;
  double torque_period_;
  bool hovers_;
  RobotState state_;
  RobotTerms terms_;
  JointSpace joint_space_;
  Plant plant_;
  const OwnPlant& own_plant_;  // instead, unless empty
  Drives drives_;
  PlantInputs inputs_;
  Gusts gusts_;
  PointHeights heights_;
  FlightMeter meter_;
  Path path_;
  std::vector<ThrustState> jets_;
  Eigen::VectorXd thrust_, last_thrust_, thrust_rate_, command_, joint_velocity_, force_,
      joint_force_;
  ControllerOrigin origin_;
  Pose start_;  // base rotation and center of mass that a path counts from
  ReferenceGenerator reference_generator_;
  Reference reference_;
  MomentumObserver observer_;
  Vector6d unmodeled_ = Vector6d::Zero();
  MomentumTask task_;
  MomentumQp qp_;
  DelayLine outputs_;  // of the momentum QP
  BoxQpSolver qp_solver_;
  TorqueController torque_controller_;
  std::vector<JetMount> mounts_;
  std::optional<PairedBodies> bodies_;  // for torques with a held inertia
  double com_error_ = 0.0, attitude_error_ = 0.0;
  FlightLog log_;
  Stopwatch watch_;
};

Flight::Flight(const Model& model, const FlightSettings& settings, const FlightStart& start,
               const OwnPlant& own_plant)
    : model_(model),
      settings_(settings),
      torque_period_(settings.step / settings.torque_updates),
      hovers_(start.hovers),
      state_(start.state),
      terms_(model, settings.actuators, settings.rotor_inertia),
      joint_space_(model.joint_count()),
      plant_(model, settings),
      own_plant_(own_plant),
      drives_(settings),
      gusts_(settings),
      heights_(model, settings),
      meter_(model.joint_count(), settings.fuel),
      path_(settings.path),
      thrust_(start.thrusts),
      last_thrust_(start.thrusts),
      reference_generator_(settings, Vector3d::Zero(), Matrix3d::Identity()),
      observer_(settings.gains.observer, settings.step),
      task_(static_cast<int>(settings.actuators.size()), model.joint_count()),
      qp_(settings, model.joint_count()),
      outputs_(static_cast<int>(std::lround(settings.delays.momentum / settings.step))),
      qp_solver_(qp_.objective.size()),
      torque_controller_(settings) {
  const auto jets = static_cast<Index>(settings.actuators.size());
  const Index joints = model.joint_count();
  inputs_ = {Eigen::VectorXd::Zero(joints), Eigen::VectorXd::Zero(jets), Vector3d::Zero()};
  for (Eigen::VectorXd* v : {&thrust_rate_, &command_}) v->setZero(jets);
  for (Eigen::VectorXd* v : {&joint_velocity_, &joint_force_}) v->setZero(joints);
  force_.setZero(model.dofs());
  for (const double thrust : start.thrusts) jets_.push_back({thrust, 0.0});
  if (settings.hold_inertia && settings.torque_updates > 1 && !model.mimics) {
    mounts_ = mount_jets(model, settings.actuators);
    bodies_.emplace(model, settings.rotor_inertia);
  }
}

// Item 1: the state moves on under the thrusts of the last step; the torques, too, or as often as
// the torque loop updates them.
FailureReason Flight::advance_plant(int k) {
  if (k == 0 && !settings_.initial_free_fall) return FailureReason::kNotFailed;
  // The step before sample k is under the pulses that act at its start.
  const double start = std::max(k - 1, 0) * settings_.step;
  const PulseSum pulse = pulses_at(settings_.pulses, start);
  inputs_.com_force = pulse.force;
  inputs_.base_moment = pulse.moment;
  for (int i = 0; i < settings_.torque_updates; ++i) {
    const bool held = i > 0 && bodies_;
    if (i > 0) {
      if (held) {
        bodies_->move(state_.base.R, state_.joints, state_.velocity);
      } else {
        update_motion_terms(model_, state_, terms_);
        if (!joint_space_.reduce(terms_.mass_matrix)) return FailureReason::kSingularMass;
      }
      const FailureReason reason = k > 0 ? update_torque(held) : FailureReason::kNotFailed;
      if (reason != FailureReason::kNotFailed) return reason;
    }
    inputs_.base_force = gusts_.at(k > 0 ? start + (i + 0.5) * torque_period_ : start);
    if (!move(held)) return FailureReason::kSingularMass;
  }
  return plant_.fuel_left() < 0.0 ? FailureReason::kNoFuel : FailureReason::kNotFailed;
}

// By one period of the torque loop. Held: terms_ are of an earlier state, bodies_ of this one.
bool Flight::move(bool held) {
  if (own_plant_) {
    own_plant_(inputs_, torque_period_, state_);
    return true;
  }
  return held ? plant_.advance(inputs_, state_, &*bodies_)
              : plant_.advance(terms_, joint_space_, inputs_, state_);
}

// Item 2: the thrusts move on under the commands of the last step.
void Flight::advance_jets(int k) {
  if (k == 0) return;
  last_thrust_ = thrust_;
  for (std::size_t i = 0; i < jets_.size(); ++i) {
    const auto jet = static_cast<Index>(i);
    jets_[i] = advance(settings_.actuators[i], jets_[i], command_[jet], settings_.step);
    thrust_[jet] = jets_[i].thrust;
  }
}

bool Flight::update_dynamics() {
  update_terms(model_, state_, terms_);
  return joint_space_.reduce(terms_.mass_matrix);
}

// Items 3 to 5: references, momentum QP, torques.
FailureReason Flight::control(int k) {
  if (k == 0) {
    origin_ = controller_origin(settings_, state_, terms_);
    start_ = {state_.base.R, terms_.com};
    reference_generator_ = ReferenceGenerator(settings_, terms_.com, state_.base.R);
  }
  reference_ =
      settings_.path.waypoints.empty()
          ? reference_generator_.update(command_at(settings_.trajectory, k, settings_.step))
          : path_reference(path_, k * settings_.step, start_);

  jet_map(terms_, task_.A);
  unmodeled_ =
      observer_.update(terms_.momentum, modeled_momentum_rate(terms_, task_.A, last_thrust_),
                       modeled_momentum_rate(terms_, task_.A, thrust_));
  build_momentum_task(model_, settings_, origin_, state_, terms_, thrust_, reference_, unmodeled_,
                      task_);
  build_momentum_qp(settings_, origin_, task_, state_, thrust_, qp_);
  watch_.lap(log_.profile.task);
  const BoxQpResult& solution = qp_solver_.solve(qp_.objective, qp_.lower, qp_.upper);
  watch_.lap(log_.profile.momentum_qp);
  if (solution.status != QpStatus::kSolved) return FailureReason::kMomentumQp;
  const Eigen::VectorXd& outputs = outputs_.pass(solution.x);
  thrust_rate_ = outputs.head(thrust_.size());
  joint_velocity_ = outputs.tail(joint_velocity_.size());
  command_jets();
  inputs_.thrust = thrust_;
  const FailureReason reason = update_torque(false);
  watch_.lap(log_.profile.torque);
  return reason;
}

// Item 5, also between the samples: torques for the joint velocities commanded last. Held: with the
// joint-space inertia of the sample.
FailureReason Flight::update_torque(bool held) {
  if (held) {
    push_jets(mounts_, thrust_, *bodies_);
    bodies_->generalized_forces(force_);
  } else {
    force_ = -terms_.bias;
    add_jet_forces(model_, terms_, thrust_, force_);
    if (!torque_controller_.renew(joint_space_)) return FailureReason::kTorqueQp;
  }
  joint_space_.reduce_force(force_, joint_force_);
  const auto joint_velocity = state_.velocity.tail(model_.joint_count());
  if (torque_controller_.follow(joint_space_, joint_force_, joint_velocity, joint_velocity_) !=
      QpStatus::kSolved) {
    return FailureReason::kTorqueQp;
  }
  inputs_.torque = drives_.act(torque_controller_.torque());
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

void Flight::log_sample(int k) {
  FlightLog& log = log_;
  log_state(state_, terms_, k, log);
  log.time(k, 0) = k * settings_.step;
  log.com_reference.row(k) = reference_.position.transpose();
  log.com_velocity_reference.row(k) = reference_.velocity.transpose();
  write_rotation(reference_.rotation, log.rotation_reference, k);
  log.angular_velocity_reference.row(k) = reference_.angular_velocity.transpose();
  const double mass = terms_.robot.mass;
  Vector6d error = terms_.momentum;
  error.head<3>() -= mass * reference_.velocity;
  error.tail<3>() -= reference_.rotation * (origin_.base_inertia * reference_.angular_velocity);
  log.momentum_error.row(k) = error.transpose();
  log.unmodeled_force.row(k) = unmodeled_.transpose();
  log.thrust.row(k) = thrust_.transpose();
  log.thrust_rate_command.row(k) = thrust_rate_.transpose();
  log.thrust_command.row(k) = command_.transpose();
  log.joint_velocity_command.row(k) = joint_velocity_.transpose();
  log.torque.row(k) = inputs_.torque.transpose();
  log.wind.row(k) = inputs_.base_force.transpose();
  log.clearance(k, 0) = heights_.lowest(terms_);
  measure(k);
  const BoxQpResult& qp = qp_solver_.result();
  log.qp_iterations(k, 0) = qp.iterations;
  log.qp_iterations(k, 1) = torque_controller_.iterations();
  log.active_bounds(k, 0) = static_cast<int>((qp.multipliers.array() != 0.0).count());
  log.max_com_error = std::max(log.max_com_error, com_error_);
  log.max_attitude_error = std::max(log.max_attitude_error, attitude_error_);
}

void Flight::measure(int k) {
  const bool last = k + 1 == sample_count(settings_);
  const Vector3d rpy_error =
      angle_difference(rotation_to_rpy(state_.base.R), rotation_to_rpy(reference_.rotation));
  meter_.add(last ? 0.0 : settings_.step, terms_.com - reference_.position, rpy_error,
             attitude_error_, inputs_.torque, state_.velocity.tail(model_.joint_count()), thrust_);
}

FlightLog Flight::run() {
  const int samples = sample_count(settings_);
  log_ =
      make_flight_log(samples, model_.joint_count(), static_cast<int>(settings_.actuators.size()));
  log_.step = settings_.step;
  if (!hovers_) set_failure(FailureReason::kNoHover, 0.0, log_);
  if (!update_dynamics()) set_failure(FailureReason::kSingularMass, 0.0, log_);
  watch_ = {};
  for (int k = 0; k < samples && log_.status == FlightStatus::kCompleted; ++k) {
    check_interrupt();
    FailureReason reason = advance_plant(k);
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
    if (reason != FailureReason::kNotFailed) set_failure(reason, k * settings_.step, log_);
  }
  if (settings_.tank) log_.fuel_burnt = settings_.tank->fuel - plant_.fuel_left();
  log_.measures = meter_.result();
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

}  // namespace

FlightLog simulate_flight(const Model& model, const FlightSettings& settings) {
  return simulate_flight(model, settings, OwnPlant());
}

FlightLog simulate_flight(const Model& model, const FlightSettings& asked, const OwnPlant& plant) {
  const bool predictive = asked.controller == Controller::kPredictive;
  if (predictive && plant) {
    throw std::invalid_argument(
        "simulate_flight: a plant of your own flies under the momentum controller only");
  }
  const FlightSettings settings = fitted(model, asked);
  const FlightStart start = flight_start(model, settings);
  FlightLog log = predictive ? simulate_predictive_flight(model, settings, start)
                             : Flight(model, settings, start, plant).run();
  log.measures.hover_margin = hover_margin(settings.actuators, start.thrusts);
  if (log.samples < log.time.rows()) truncate(log);
  summarize(model, settings, log);
  return log;
}

std::vector<FlightLog> simulate_flights(const Model& model, const FlightSettings& settings,
                                        const std::vector<std::uint64_t>& seeds) {
  std::vector<FlightLog> logs;
  FlightSettings drawn = settings;
  for (const std::uint64_t seed : seeds) {
    drawn.disturbances.seed = seed;
    logs.push_back(simulate_flight(model, drawn));
  }
  return logs;
}

}  // namespace codesign::dynamics
