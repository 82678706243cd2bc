#include "dynamics/momentum_controller.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "dynamics/paired/lanes.hpp"

namespace codesign::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

ControllerOrigin controller_origin(const FlightSettings& settings, const RobotState& state,
                                   const RobotTerms& terms) {
  const Matrix3d inertia = state.base.R.transpose() * terms.robot.inertia * state.base.R;
  const bool own = settings.posture_reference.size() > 0;
  return {inertia, inertia.inverse(), own ? settings.posture_reference : state.joints};
}

Vector6d modeled_momentum_rate(const RobotTerms& terms, const Eigen::Ref<const Matrix6Xd>& A,
                               const Eigen::Ref<const Eigen::VectorXd>& thrusts) {
  Vector6d rate = A * thrusts;
  rate[2] -= terms.robot.mass * kGravity;
  return rate;
}

MomentumTask::MomentumTask(int jets, int joints) {
  A.setZero(6, jets);
  Lambda.setZero(6, kBaseDofs + joints);
  rows.setZero(kTaskRows, jets + joints);
  offset.setZero();
}

MomentumQp::MomentumQp(const FlightSettings& settings, int joints)
    : objective(kTaskRows + static_cast<int>(settings.symmetry_pairs.size()),
                static_cast<int>(settings.actuators.size()) + joints),
      lower(Eigen::VectorXd::Zero(objective.size())),
      upper(lower) {
  const Weights& w = settings.weights;
  Eigen::VectorXd damping =
      Eigen::VectorXd::Constant(lower.size(), w.thrust_rate + w.regularization);
  damping.tail(joints).setConstant(w.posture + w.joint_velocity + w.regularization);
  objective.set_damping(damping);
  Eigen::Index row = kTaskRows;
  for (const auto& [a, b] : settings.symmetry_pairs) {
    objective.scaled(row, a) = std::sqrt(w.thrust_symmetry) * objective.unit()[a];
    objective.scaled(row, b) = -std::sqrt(w.thrust_symmetry) * objective.unit()[b];
    ++row;
  }
}

namespace {

// L̈* + σ of the attitude law, base axes: the wanted R_Bᵀ ẅ.
Vector3d wanted_angular_acceleration(const Gains& gains, const ControllerOrigin& origin,
                                     const RobotState& state, const Vector3d& angular_rate,
                                     const Reference& reference) {
  const Matrix3d& I0 = origin.base_inertia;
  const Matrix3d& I0_inverse = origin.base_inertia_inverse;
  const Matrix3d& R = state.base.R;
  const Vector3d omega = R.transpose() * state.velocity.segment<3>(3);
  const Vector3d L = I0 * omega;
  const Vector3d L_d = I0 * reference.angular_velocity;
  const Vector3d L_rate_d = I0 * reference.angular_acceleration;
  const Vector3d L_acceleration_d = I0 * reference.angular_jerk;
  const Vector3d L_rate = R.transpose() * angular_rate - omega.cross(L);
  const Matrix3d R_e = reference.rotation.transpose() * R;
  const Vector3d e = skew_part(R_e);
  const Vector3d e_rate = skew_part(R_e * skew(omega) - skew(reference.angular_velocity) * R_e);
  const double c0 = gains.attitude_proportional;
  const double c1 = gains.attitude_derivative;

  const Vector3d rate_error = L_rate - L_rate_d;
  const Vector3d wanted = L_acceleration_d - e_rate - rate_error -
                          I0_inverse * (c0 * rate_error + c0 * e + c1 * (L - L_d));
  const Vector3d transport =
      omega.cross(omega.cross(L)) + 2.0 * omega.cross(L_rate) + (I0_inverse * L_rate).cross(L);
  return wanted + transport;
}

}  // namespace

void build_momentum_task(const Model& model, const FlightSettings& settings,
                         const ControllerOrigin& origin, const RobotState& state,
                         const RobotTerms& terms, const Eigen::Ref<const Eigen::VectorXd>& thrusts,
                         const Reference& reference, const Vector6d& unmodeled,
                         MomentumTask& task) {
  const Eigen::Index jets = thrusts.size();
  const Eigen::Index joints = state.joints.size();
  jet_map(terms, task.A);
  jet_map_rate(model, terms, thrusts, task.Lambda);
  const Matrix6Xd& C = terms.momentum_matrix;
  const Matrix6Xd& Lambda = task.Lambda;
  const Eigen::Index joint_columns = kBaseDofs;
  const double mass = terms.robot.mass;
  const Vector6d base_velocity = state.velocity.head<kBaseDofs>();
  const Vector6d momentum_rate = modeled_momentum_rate(terms, task.A, thrusts) + unmodeled;

  // Linear part, world axes.
  const Gains& gains = settings.gains;
  const double K_P = gains.momentum_proportional;
  const double K_D = gains.momentum_derivative;
  const double K = K_P + 1.0 / gains.momentum_integral + K_D;
  task.rows.topLeftCorner(3, jets) = task.A.topRows<3>();
  task.rows.topRightCorner(3, joints) =
      Lambda.topRightCorner(3, joints) + K * C.topRightCorner(3, joints);
  task.offset.head<3>() =
      (Lambda.topLeftCorner<3, kBaseDofs>() + K * C.topLeftCorner<3, kBaseDofs>()) * base_velocity -
      K * mass * reference.velocity - mass * reference.jerk +
      (1.0 + K_D) * (momentum_rate.head<3>() - mass * reference.acceleration) +
      K_P * mass * (terms.com - reference.position);

  // Angular part, base axes; then the constant-inertia task.
  const Matrix3d& R = state.base.R;
  for (Eigen::Index i = 0; i < jets; ++i) {
    task.rows.col(i).segment<3>(3) = R.transpose() * task.A.col(i).tail<3>();
  }
  for (Eigen::Index j = 0; j < joints; ++j) {
    task.rows.col(jets + j).segment<3>(3) = R.transpose() * Lambda.col(joint_columns + j).tail<3>();
    task.rows.col(jets + j).tail<3>() = R.transpose() * C.col(joint_columns + j).tail<3>();
  }
  const Vector3d base_part = Lambda.bottomLeftCorner<3, kBaseDofs>() * base_velocity;
  task.offset.segment<3>(3) =
      R.transpose() * base_part -
      wanted_angular_acceleration(gains, origin, state, momentum_rate.tail<3>(), reference);
  const Vector3d omega = R.transpose() * base_velocity.tail<3>();
  task.offset.tail<3>() =
      R.transpose() * (terms.robot.inertia * base_velocity.tail<3>()) - origin.base_inertia * omega;
}

namespace {

// Bounds that close smoothly towards the ends of each range; outside a range the bound changes sign
// and drives the variable back in.
void write_bounds(const FlightSettings& settings, const RobotState& state,
                  const Eigen::Ref<const Eigen::VectorXd>& thrusts, MomentumQp& qp) {
  const Limits& limits = settings.limits;
  const Eigen::Index jets = thrusts.size();
  for (Eigen::Index i = 0; i < jets; ++i) {
    const Actuator& jet = settings.actuators[static_cast<std::size_t>(i)];
    const Lanes room = lanes(thrusts[i] - jet.thrust_min, jet.thrust_max - thrusts[i]);
    const Lanes share = hyperbolic_tangent(limits.thrust_slope * room);
    qp.lower[i] = -jet.thrust_rate * share[0];
    qp.upper[i] = jet.thrust_rate * share[1];
  }
  for (Eigen::Index j = 0; j < state.joints.size(); ++j) {
    const double scale = limits.joint_range_scale[j];
    const double s = state.joints[j];
    const Lanes room = lanes(s - scale * limits.joint_lower[j], scale * limits.joint_upper[j] - s);
    const Lanes share = hyperbolic_tangent(limits.joint_slope * room);
    qp.lower[jets + j] = -limits.joint_speed * share[0];
    qp.upper[jets + j] = limits.joint_speed * share[1];
  }
}

}  // namespace

void build_momentum_qp(const FlightSettings& settings, const ControllerOrigin& origin,
                       const MomentumTask& task, const RobotState& state,
                       const Eigen::Ref<const Eigen::VectorXd>& thrusts, MomentumQp& qp) {
  const Weights& w = settings.weights;
  const Eigen::Index joints = state.joints.size();
  TaskObjective& objective = qp.objective;
  Eigen::Matrix<double, kTaskRows, 1> root;
  root << Vector6d::Constant(std::sqrt(w.momentum)),
      Vector3d::Constant(std::sqrt(w.constant_inertia));
  for (Eigen::Index i = 0; i < task.rows.cols(); ++i) {
    objective.scaled.col(i).head<kTaskRows>() =
        task.rows.col(i).cwiseProduct(objective.unit()[i] * root);
  }
  objective.offset.head<kTaskRows>() = root.cwiseProduct(task.offset);
  objective.scaled_linear.tail(joints) =
      w.posture * settings.gains.posture.cwiseProduct(state.joints - origin.posture)
                      .cwiseProduct(objective.unit().tail(joints));

  write_bounds(settings, state, thrusts, qp);
}

}  // namespace codesign::dynamics
