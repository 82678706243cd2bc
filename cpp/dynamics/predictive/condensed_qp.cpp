#include "dynamics/predictive/condensed_qp.hpp"

#include <cmath>

#include "dynamics/dense_kernels.hpp"

namespace codesign::dynamics {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr int kWeighted = 18;  // states with a weight: six vectors

// to.topRows(rows) += from.topRows(rows) Mᵀ.
template <typename To, typename From>
void add_mapped(To& to, const From& from, const Matrix3d& M, Index rows) {
  for (int i = 0; i < 3; ++i) {
    to.col(i).head(rows) += M(i, 0) * from.col(0).head(rows) + M(i, 1) * from.col(1).head(rows) +
                            M(i, 2) * from.col(2).head(rows);
  }
}

}  // namespace

PredictionTask::PredictionTask(int steps, int joints, int jets)
    : state(jets),
      references(static_cast<std::size_t>(steps)),
      posture_error(Eigen::VectorXd::Zero(joints)),
      variable(Eigen::VectorXd::Zero(jets)) {}

CondensedQp::CondensedQp(const PredictiveSettings& settings, int joints, int jets)
    : weights_(settings.weights),
      jet_dynamics_(settings.model.jet_dynamics),
      grid_(make_prediction_grid(settings, joints, jets)),
      joints_(joints),
      jets_(jets) {
  const Index rows = 1 + grid_.unknowns;
  for (Columns3* c :
       {&com_, &linear_, &rpy_, &angular_, &com_integral_, &rpy_integral_, &change_}) {
    c->setZero(rows, 3);
  }
  for (Eigen::MatrixXd* m : {&thrust_, &thrust_rate_, &thrust_next_}) m->setZero(rows, jets);
  weighted_.setZero(rows, kWeighted);
  gram_.setZero(rows, rows);
}

void CondensedQp::build(const PredictionModel& model, const PredictionTask& task) {
  gram_.setZero();
  start(task);
  for (std::size_t k = 0; k < grid_.steps.size(); ++k) {
    advance(model, task, grid_.steps[k]);
    add_cost(task.references[k], 1 + grid_.steps[k].used);
  }
  add_input_cost(task);
  for (Index j = 0; j < gram_.cols(); ++j) {
    for (Index i = j + 1; i < gram_.rows(); ++i) gram_(j, i) = gram_(i, j);
  }
}

void CondensedQp::start(const PredictionTask& task) {
  const PredictionState& state = task.state;
  for (Columns3* c : {&com_, &linear_, &rpy_, &angular_, &com_integral_, &rpy_integral_}) {
    c->setZero();
  }
  com_.row(0) = state.com;
  linear_.row(0) = state.linear_momentum;
  rpy_.row(0) = state.rpy;
  angular_.row(0) = state.angular_momentum;
  com_integral_.row(0) = state.com_integral;
  rpy_integral_.row(0) = state.rpy_integral;
  thrust_.setZero();
  thrust_rate_.setZero();
  thrust_.row(0) = state.thrust;
  thrust_rate_.row(0) = state.thrust_rate;
}

// One explicit Euler step; every rate is taken before what it depends on moves.
void CondensedQp::advance(const PredictionModel& model, const PredictionTask& task,
                          const PredictionGrid::Step& step) {
  const double h = step.length;
  const Index rows = 1 + step.used;
  const auto add_error = [&](Columns3& integral, const Columns3& value, const Vector3d& reference) {
    integral.topRows(rows) += h * value.topRows(rows);
    integral.row(0) -= h * reference;
  };
  add_error(com_integral_, com_, task.now.com);
  add_error(rpy_integral_, rpy_, task.now.rpy);
  add_mapped(com_, linear_, (h / model.mass) * model.world_R_body, rows);
  add_forces(model, step, rows);
  advance_jets(model, step, rows);
}

// Momenta move on under thrusts, joints and weight; the attitude with the angular momentum before.
void CondensedQp::add_forces(const PredictionModel& model, const PredictionGrid::Step& step,
                             Rows rows) {
  const double h = step.length;
  if (!jet_dynamics_) {
    // The thrusts that the step's throttles hold, at once.
    const int column = grid_.throttle_columns[static_cast<std::size_t>(step.throttle_block)];
    thrust_.setZero();
    for (int i = 0; i < jets_; ++i) {
      const JetPrediction& jet = model.jets[static_cast<std::size_t>(i)];
      thrust_(0, i) = jet.thrust - jet.static_gain * jet.variable;
      thrust_(1 + column + i, i) = jet.static_gain;
    }
  }
  const Matrix3d turning = -h * skew(model.angular_velocity);
  const Index first = 1 + grid_.joint_columns[static_cast<std::size_t>(step.joint_block)];
  const auto add = [&](Columns3& momentum, const Matrix3Xd& of_thrust, const Matrix3Xd& of_joint) {
    change_.topRows(rows).setZero();
    add_mapped(change_, momentum, turning, rows);
    for (int i = 0; i < jets_; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        change_.col(axis).head(rows) += (h * of_thrust(axis, i)) * thrust_.col(i).head(rows);
      }
    }
    for (Index j = 0; j < joints_; ++j) {
      for (int axis = 0; axis < 3; ++axis) change_(first + j, axis) += h * of_joint(axis, j);
    }
  };
  add(linear_, model.force_of_thrust, model.force_of_joint);
  change_.row(0) += h * (model.weight - model.weight_per_rpy * model.rpy);
  add_mapped(change_, rpy_, h * model.weight_per_rpy, rows);
  linear_.topRows(rows) += change_.topRows(rows);
  add_mapped(rpy_, angular_, h * model.rpy_rate, rows);
  add(angular_, model.moment_of_thrust, model.moment_of_joint);
  angular_.topRows(rows) += change_.topRows(rows);
}

void CondensedQp::advance_jets(const PredictionModel& model, const PredictionGrid::Step& step,
                               Rows rows) {
  if (!jet_dynamics_) return;
  const double h = step.length;
  const Index first = 1 + grid_.throttle_columns[static_cast<std::size_t>(step.throttle_block)];
  for (int i = 0; i < jets_; ++i) {
    const JetPrediction& jet = model.jets[static_cast<std::size_t>(i)];
    auto thrust = thrust_.col(i).head(rows);
    auto rate = thrust_rate_.col(i).head(rows);
    auto next = thrust_next_.col(i).head(rows);
    next = thrust + h * rate;
    rate += (h * jet.per_thrust) * thrust + (h * jet.per_rate) * rate;
    rate[0] += h * (jet.constant - jet.per_thrust * jet.thrust - jet.per_rate * jet.thrust_rate -
                    jet.per_variable * jet.variable);
    rate[first + i] += h * jet.per_variable;
    thrust = next;
  }
}

void CondensedQp::add_cost(const PredictionReference& reference, Rows rows) {
  const Vector3d none = Vector3d::Zero();
  struct Term {
    const Columns3& value;
    const Vector3d& reference;
    const Vector3d& weight;
  } const terms[] = {{com_, reference.com, weights_.com},
                     {linear_, reference.linear_momentum, weights_.linear_momentum},
                     {rpy_, reference.rpy, weights_.attitude},
                     {angular_, reference.angular_momentum, weights_.angular_momentum},
                     {com_integral_, none, weights_.com_integral},
                     {rpy_integral_, none, weights_.attitude_integral}};
  Index column = 0;
  for (const Term& term : terms) {
    for (int axis = 0; axis < 3; ++axis, ++column) {
      const double root = std::sqrt(term.weight[axis]);
      weighted_.col(column).head(rows) = root * term.value.col(axis).head(rows);
      weighted_(0, column) -= root * term.reference[axis];
    }
  }
  add_outer_product(gram_.data(), static_cast<int>(rows), static_cast<int>(gram_.outerStride()),
                    weighted_.data(), kWeighted, static_cast<int>(weighted_.outerStride()), 1.0);
}

// Lower triangle: joint displacements and posture, first throttle and changes between blocks.
void CondensedQp::add_input_cost(const PredictionTask& task) {
  for (const int block : grid_.joint_columns) {
    for (int j = 0; j < joints_; ++j) {
      const Index row = 1 + block + j;
      gram_(row, row) += weights_.joint_displacement + weights_.posture;
      gram_(row, 0) += weights_.posture * task.posture_error[j];
    }
  }
  int last = -1;
  for (const int block : grid_.throttle_columns) {
    for (int i = 0; i < jets_; ++i) {
      const Index row = 1 + block + i;
      if (last < 0) {
        gram_(row, row) += weights_.throttle_first;
        gram_(row, 0) -= weights_.throttle_first * task.variable[i];
      } else {
        const Index before = 1 + last + i;
        gram_(row, row) += weights_.throttle_change;
        gram_(before, before) += weights_.throttle_change;
        gram_(row, before) -= weights_.throttle_change;
      }
    }
    last = block;
  }
}

}  // namespace codesign::dynamics
