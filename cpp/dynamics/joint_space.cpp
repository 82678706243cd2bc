#include "dynamics/joint_space.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

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

bool JointSpace::reduce(const Eigen::Ref<const Eigen::MatrixXd>& M) {
  const Eigen::Index n = joint_inertia_.rows();
  const int size = static_cast<int>(n);
  factored_ = false;
  base_.compute(M.topLeftCorner<kBaseDofs, kBaseDofs>());
  if (base_.info() != Eigen::Success) return false;
  const Matrix6d L = base_.matrixL();
  const auto stride = static_cast<std::size_t>(M.outerStride());
  for (int k = 0; k < kBaseDofs; ++k) {
    const double* source = M.data() + static_cast<std::size_t>(k) * stride + kBaseDofs;
    std::copy_n(source, size, coupling_.col(k).data());
    double* column = half_.col(k).data();
    std::copy_n(source, size, column);
    for (int i = 0; i < k; ++i) {
      const double* earlier = half_.col(i).data();
      for (int r = 0; r < size; ++r) column[r] -= L(k, i) * earlier[r];
    }
    const double scale = 1.0 / L(k, k);
    for (int r = 0; r < size; ++r) column[r] *= scale;
  }
  for (int j = 0; j < size; ++j) {
    const double* source = M.data() + static_cast<std::size_t>(kBaseDofs + j) * stride + kBaseDofs;
    std::copy_n(source, size, joint_inertia_.col(j).data());
  }
  add_outer_product(joint_inertia_.data(), size, size, half_.data(), kBaseDofs, size, -1.0);
  mirror(joint_inertia_.data(), size);
  return std::isfinite(joint_inertia_.sum());
}

bool JointSpace::factor() {
  if (factored_) return true;
  const int size = static_cast<int>(joint_inertia_.rows());
  factor_ = joint_inertia_;
  definite_ = cholesky_in_place(factor_.data(), size, size);
  if (!definite_) {
    factor_ = joint_inertia_;
    if (!lu_in_place(factor_.data(), size, size, pivots_.data())) return false;
  }
  factored_ = true;
  return true;
}

bool JointSpace::set_mass_matrix(const Eigen::Ref<const Eigen::MatrixXd>& M) {
  return reduce(M) && factor();
}

void JointSpace::reduce_force(const Eigen::Ref<const Eigen::VectorXd>& force,
                              Eigen::VectorXd& joint_force) const {
  const int size = static_cast<int>(joint_inertia_.rows());
  const Vector6d base_force = -base_.matrixL().solve(force.head<kBaseDofs>());
  joint_force = force.tail(size);
  add_product(half_.data(), size, kBaseDofs, size, base_force.data(), joint_force.data());
}

void JointSpace::solve_joint_inertia(Eigen::VectorXd& x) const {
  assert(factored_);
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
