#include "dynamics/momentum_controller.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "dynamics/dense_kernels.hpp"

namespace codesign::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

ControllerOrigin controller_origin(const FlightSettings& settings, const RobotState& state,
                                   const RobotTerms& terms) {
  const Matrix3d inertia = state.base.R.transpose() * locked_inertia(terms.inertia) * state.base.R;
  const bool own = settings.posture_reference.size() > 0;
  return {inertia, inertia.inverse(), own ? settings.posture_reference : state.joints};
}

Vector6d modeled_momentum_rate(const RobotTerms& terms, const Eigen::Ref<const Matrix6Xd>& A,
                               const Eigen::Ref<const Eigen::VectorXd>& thrusts) {
  Vector6d rate = A * thrusts;
  rate[2] -= terms.inertia.subtrees[0].mass * kGravity;
  return rate;
}

MomentumTask::MomentumTask(int jets, int joints) {
  A.setZero(6, jets);
  Lambda.setZero(6, kBaseDofs + joints);
  rows.setZero(jets + joints, kTaskRows);
  offset.setZero();
}

MomentumQp::MomentumQp(int size)
    : H(Eigen::MatrixXd::Zero(size, size)),
      g(Eigen::VectorXd::Zero(size)),
      lower(Eigen::VectorXd::Zero(size)),
      upper(Eigen::VectorXd::Zero(size)) {}

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
  const double mass = terms.inertia.subtrees[0].mass;
  const Vector6d base_velocity = state.velocity.head<kBaseDofs>();
  const Vector6d momentum_rate = modeled_momentum_rate(terms, task.A, thrusts) + unmodeled;

  // Linear part, world axes.
  const Gains& gains = settings.gains;
  const double K_P = gains.momentum_proportional;
  const double K_D = gains.momentum_derivative;
  const double K = K_P + 1.0 / gains.momentum_integral + K_D;
  task.rows.topLeftCorner(jets, 3) = task.A.topRows<3>().transpose();
  task.rows.bottomLeftCorner(joints, 3) =
      (Lambda.topRows<3>() + K * C.topRows<3>()).rightCols(joints).transpose();
  task.offset.head<3>() =
      (Lambda.topLeftCorner<3, kBaseDofs>() + K * C.topLeftCorner<3, kBaseDofs>()) * base_velocity -
      K * mass * reference.velocity - mass * reference.jerk +
      (1.0 + K_D) * (momentum_rate.head<3>() - mass * reference.acceleration) +
      K_P * mass * (terms.com - reference.position);

  // Angular part, base axes; then the constant-inertia task.
  const Matrix3d& R = state.base.R;
  for (Eigen::Index i = 0; i < jets; ++i) {
    task.rows.row(i).segment<3>(3) = (R.transpose() * task.A.col(i).tail<3>()).transpose();
  }
  for (Eigen::Index j = 0; j < joints; ++j) {
    task.rows.row(jets + j).segment<3>(3) =
        (R.transpose() * Lambda.col(joint_columns + j).tail<3>()).transpose();
    task.rows.row(jets + j).tail<3>() =
        (R.transpose() * C.col(joint_columns + j).tail<3>()).transpose();
  }
  const Vector3d base_part = Lambda.bottomLeftCorner<3, kBaseDofs>() * base_velocity;
  task.offset.segment<3>(3) =
      R.transpose() * base_part -
      wanted_angular_acceleration(gains, origin, state, momentum_rate.tail<3>(), reference);
  const Vector3d omega = R.transpose() * base_velocity.tail<3>();
  task.offset.tail<3>() =
      R.transpose() * (locked_inertia(terms.inertia) * base_velocity.tail<3>()) -
      origin.base_inertia * omega;
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
    qp.lower[i] = -jet.thrust_rate * std::tanh(limits.thrust_slope * (thrusts[i] - jet.thrust_min));
    qp.upper[i] = jet.thrust_rate * std::tanh(limits.thrust_slope * (jet.thrust_max - thrusts[i]));
  }
  for (Eigen::Index j = 0; j < state.joints.size(); ++j) {
    const double scale = limits.joint_range_scale[j];
    const double s = state.joints[j];
    qp.lower[jets + j] =
        -limits.joint_speed * std::tanh(limits.joint_slope * (s - scale * limits.joint_lower[j]));
    qp.upper[jets + j] =
        limits.joint_speed * std::tanh(limits.joint_slope * (scale * limits.joint_upper[j] - s));
  }
}

}  // namespace

void build_momentum_qp(const FlightSettings& settings, const ControllerOrigin& origin,
                       const MomentumTask& task, const RobotState& state,
                       const Eigen::Ref<const Eigen::VectorXd>& thrusts, MomentumQp& qp) {
  const Weights& w = settings.weights;
  const Eigen::Index jets = thrusts.size();
  const Eigen::Index joints = state.joints.size();
  const int size = static_cast<int>(qp.g.size());
  const int stride = static_cast<int>(qp.H.outerStride());

  qp.H.setZero();
  qp.H.diagonal().head(jets).setConstant(w.thrust_rate + w.regularization);
  qp.H.diagonal().tail(joints).setConstant(w.posture + w.joint_velocity + w.regularization);
  for (const auto& [a, b] : settings.symmetry_pairs) {
    qp.H(a, a) += w.thrust_symmetry;
    qp.H(b, b) += w.thrust_symmetry;
    qp.H(std::max(a, b), std::min(a, b)) -= w.thrust_symmetry;
  }
  const double* rows = task.rows.data();
  add_outer_product(qp.H.data(), size, stride, rows, 6, size, w.momentum);
  add_outer_product(qp.H.data(), size, stride, rows + 6 * size, 3, size, w.constant_inertia);
  qp.H.triangularView<Eigen::StrictlyUpper>() = qp.H.transpose();

  qp.g.noalias() = task.rows.leftCols<6>() * (w.momentum * task.offset.head<6>());
  qp.g.noalias() += task.rows.rightCols<3>() * (w.constant_inertia * task.offset.tail<3>());
  qp.g.tail(joints) +=
      w.posture * settings.gains.posture.cwiseProduct(state.joints - origin.posture);

  write_bounds(settings, state, thrusts, qp);
}

}  // namespace codesign::dynamics
