#include "dynamics/predictive/predictive_controller.hpp"

#include <algorithm>
#include <cmath>

namespace codesign::dynamics {

using Eigen::Index;
using Eigen::Vector3d;

PredictiveController::PredictiveController(const Model& model, const FlightSettings& settings)
    : model_(model),
      settings_(settings.predictive),
      builder_(model, settings),
      prediction_(builder_.joint_count(), builder_.jet_count()),
      path_(settings.path),
      qp_(settings_, builder_.joint_count(), builder_.jet_count()),
      task_(static_cast<int>(qp_.grid().steps.size()), builder_.joint_count(),
            builder_.jet_count()),
      solver_(qp_.size()) {
  lower_.setZero(qp_.size());
  upper_.setZero(qp_.size());
  home_.setZero(model.joint_count());
  set_points_ = set_point_rate_ = home_;
  throttles_.setZero(builder_.jet_count());
  for (Vector3d* v : {&com_start_, &rpy_start_, &last_rpy_, &com_error_sum_, &rpy_error_sum_}) {
    v->setZero();
  }
}

void PredictiveController::start(const RobotTerms& terms, const std::vector<ThrustState>& jets,
                                 const Eigen::VectorXd& set_points) {
  last_rpy_.setZero();
  builder_.measure(terms, jets, last_rpy_, task_.state);
  com_start_ = task_.state.com;
  rpy_start_ = last_rpy_ = task_.state.rpy;
  com_error_sum_.setZero();
  rpy_error_sum_.setZero();
  home_ = set_points_ = set_points;
  set_point_rate_.setZero();
  Eigen::VectorXd variables(builder_.jet_count());
  for (std::size_t i = 0; i < jets.size(); ++i) {
    variables[static_cast<Index>(i)] = steady_variable(builder_.turbines()[i], jets[i].thrust);
  }
  set_variables(variables);
  solver_.reset();
}

void PredictiveController::set_variables(const Eigen::VectorXd& variables) {
  for (Index i = 0; i < variables.size(); ++i) {
    const StandardizedTurbine& turbine = builder_.turbines()[static_cast<std::size_t>(i)];
    task_.variable[i] = std::clamp(variables[i], throttle_variable(turbine, 0.0),
                                   throttle_variable(turbine, turbine.throttle_max));
    throttles_[i] = throttle_of_variable(turbine, task_.variable[i]);
  }
}

Vector3d PredictiveController::com_reference(double time) const {
  return com_start_ + path_.at(time).value.head<3>();
}

Vector3d PredictiveController::rpy_reference(double time) const {
  return rpy_start_ + path_.at(time).value[3] * Vector3d::UnitZ();
}

PredictionReference PredictiveController::reference_at(double time) const {
  const PathPoint point = path_.at(time);
  PredictionReference reference;
  reference.com = com_start_ + point.value.head<3>();
  reference.linear_momentum =
      prediction_.mass * (prediction_.world_R_body.transpose() * point.velocity.head<3>());
  reference.rpy = rpy_start_ + point.value[3] * Vector3d::UnitZ();
  reference.angular_momentum =
      prediction_.inertia *
      (rpy_rate_to_angular_velocity(prediction_.rpy).col(2) * point.velocity[3]);
  return reference;
}

void PredictiveController::set_integrals() {
  const Vector3d com_error = task_.state.com - task_.now.com;
  const Vector3d rpy_error = task_.state.rpy - task_.now.rpy;
  com_error_sum_ += settings_.period * com_error;
  rpy_error_sum_ += settings_.period * rpy_error;
  const bool restart = settings_.integral == PredictiveIntegral::kRestart;
  task_.state.com_integral = restart ? com_error : com_error_sum_;
  task_.state.rpy_integral = restart ? rpy_error : rpy_error_sum_;
}

QpStatus PredictiveController::solve(int k, const RobotTerms& terms,
                                     const std::vector<ThrustState>& jets) {
  const double time = k * settings_.period;
  builder_.measure(terms, jets, last_rpy_, task_.state);
  last_rpy_ = task_.state.rpy;
  if (settings_.model.varying || k == 0) {
    builder_.build(terms, task_.state, task_.variable, prediction_);
  }
  task_.now = reference_at(time);
  set_integrals();
  for (std::size_t i = 0; i < task_.references.size(); ++i) {
    task_.references[i] = reference_at(time + qp_.grid().steps[i].end);
  }
  for (std::size_t j = 0; j < builder_.joints().size(); ++j) {
    const int joint = builder_.joints()[j];
    task_.posture_error[static_cast<Index>(j)] = set_points_[joint] - home_[joint];
  }
  qp_.build(prediction_, task_);
  const bool throttle_update = k % settings_.throttle_every == 0;
  set_bounds(throttle_update);
  const QpStatus status = solver_.solve(qp_.hessian(), qp_.gradient(), lower_, upper_).status;
  if (status == QpStatus::kSolved) apply(throttle_update);
  return status;
}

void PredictiveController::set_bounds(bool throttle_update) {
  const PredictionGrid& grid = qp_.grid();
  for (std::size_t block = 0; block < grid.joint_columns.size(); ++block) {
    const double reach = settings_.joint_speed * grid.steps[block].end;
    for (std::size_t j = 0; j < builder_.joints().size(); ++j) {
      const int joint = builder_.joints()[j];
      const Joint& range = model_.joints[static_cast<std::size_t>(joint)];
      const Index i = grid.joint_columns[block] + static_cast<Index>(j);
      lower_[i] = std::max(std::min(range.lower - set_points_[joint], 0.0), -reach);
      upper_[i] = std::min(std::max(range.upper - set_points_[joint], 0.0), reach);
    }
  }
  for (std::size_t block = 0; block < grid.throttle_columns.size(); ++block) {
    for (std::size_t jet = 0; jet < builder_.turbines().size(); ++jet) {
      const StandardizedTurbine& turbine = builder_.turbines()[jet];
      const auto j = static_cast<Index>(jet);
      const Index i = grid.throttle_columns[block] + j;
      const bool frozen = block == 0 && !throttle_update;
      lower_[i] = frozen ? task_.variable[j] : throttle_variable(turbine, 0.0);
      upper_[i] = frozen ? task_.variable[j] : throttle_variable(turbine, turbine.throttle_max);
    }
  }
}

void PredictiveController::apply(bool throttle_update) {
  const Eigen::VectorXd& x = solver_.result().x;
  for (std::size_t j = 0; j < builder_.joints().size(); ++j) {
    const int joint = builder_.joints()[j];
    const double move = x[qp_.grid().joint_columns[0] + static_cast<Index>(j)];
    set_points_[joint] += move;
    set_point_rate_[joint] = move / settings_.period;
  }
  if (!throttle_update) return;
  for (std::size_t jet = 0; jet < builder_.turbines().size(); ++jet) {
    const auto j = static_cast<Index>(jet);
    task_.variable[j] = x[qp_.grid().throttle_columns[0] + j];
    throttles_[j] = throttle_of_variable(builder_.turbines()[jet], task_.variable[j]);
  }
}

}  // namespace codesign::dynamics
