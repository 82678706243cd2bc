#include "dynamics/joint_space.hpp"

#include "dynamics/dense_kernels.hpp"
#include "dynamics/model.hpp"

namespace codesign::dynamics {

JointSpace::JointSpace(int joints)
    : coupling_(Eigen::MatrixXd::Zero(joints, kBaseDofs)),
      half_(Eigen::MatrixXd::Zero(joints, kBaseDofs)),
      joint_inertia_(Eigen::MatrixXd::Zero(joints, joints)),
      factor_(Eigen::MatrixXd::Zero(joints, joints)),
      pivots_(Eigen::VectorXi::Zero(joints)),
      joint_acceleration_(Eigen::VectorXd::Zero(joints)) {}

bool JointSpace::set_mass_matrix(const Eigen::Ref<const Eigen::MatrixXd>& M) {
  const Eigen::Index n = joint_inertia_.rows();
  const int size = static_cast<int>(n);
  base_.compute(M.topLeftCorner<kBaseDofs, kBaseDofs>());
  if (base_.info() != Eigen::Success) return false;
  coupling_ = M.bottomLeftCorner(n, kBaseDofs);
  half_ = coupling_;
  base_.matrixL().transpose().solveInPlace<Eigen::OnTheRight>(half_);
  joint_inertia_ = M.bottomRightCorner(n, n);
  add_outer_product(joint_inertia_.data(), size, size, half_.data(), kBaseDofs, size, -1.0);
  joint_inertia_.triangularView<Eigen::StrictlyUpper>() = joint_inertia_.transpose();
  factor_ = joint_inertia_;
  definite_ = cholesky_in_place(factor_.data(), size, size);
  if (definite_) return true;
  if (!joint_inertia_.allFinite()) return false;
  factor_ = joint_inertia_;
  return lu_in_place(factor_.data(), size, size, pivots_.data());
}

void JointSpace::reduce_force(const Eigen::Ref<const Eigen::VectorXd>& force,
                              Eigen::VectorXd& joint_force) const {
  const Vector6d base_force = force.head<kBaseDofs>();
  joint_force = force.tail(joint_inertia_.rows());
  joint_force.noalias() -= half_ * base_.matrixL().solve(base_force);
}

void JointSpace::solve_joint_inertia(Eigen::VectorXd& x) const {
  const int size = static_cast<int>(joint_inertia_.rows());
  if (definite_) {
    cholesky_solve(factor_.data(), size, size, x.data());
  } else {
    lu_solve(factor_.data(), size, size, pivots_.data(), x.data());
  }
}

void JointSpace::acceleration(const Eigen::Ref<const Eigen::VectorXd>& tau,
                              const Eigen::Ref<const Eigen::VectorXd>& force,
                              Eigen::VectorXd& nu_dot) {
  reduce_force(force, joint_acceleration_);
  joint_acceleration_ += tau;
  solve_joint_inertia(joint_acceleration_);
  Vector6d base_force = force.head<kBaseDofs>();
  base_force.noalias() -= coupling_.transpose() * joint_acceleration_;
  nu_dot.head<kBaseDofs>() = base_.solve(base_force);
  nu_dot.tail(joint_acceleration_.size()) = joint_acceleration_;
}

}  // namespace codesign::dynamics
