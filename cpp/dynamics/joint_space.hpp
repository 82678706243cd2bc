#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "dynamics/spatial.hpp"

namespace codesign::dynamics {

// Equations of motion M ν̇ = (0; τ) + f of a floating base with its six base accelerations
// eliminated, by the Schur complement of the base's block:  M̂ s̈ = τ + f̂,  M̂ = M_ss − M_sb M_bb⁻¹
// M_bs,  f̂ = f_s − M_sb M_bb⁻¹ f_b. M̂⁻¹ is the joint block of M⁻¹. Where M̂ is indefinite (robots
// with unphysical inertias), it is factored with pivoting. Nothing allocates but the constructor.
class JointSpace {
 public:
  explicit JointSpace(int joints);

  // M (6+n, 6+n) symmetric. False if M is singular or not finite. Its first half is enough for the
  // joint inertia and for reduce_force(): false if the base's block is singular, M̂ not finite. Its
  // second half factors M̂: false if that is singular.
  bool reduce(const Eigen::Ref<const Eigen::MatrixXd>& M);
  bool factor();
  bool set_mass_matrix(const Eigen::Ref<const Eigen::MatrixXd>& M);

  const Eigen::MatrixXd& joint_inertia() const { return joint_inertia_; }  // M̂ (n, n), full

  // f̂ (n,) of f (6+n,).
  void reduce_force(const Eigen::Ref<const Eigen::VectorXd>& force,
                    Eigen::VectorXd& joint_force) const;

  // x becomes M̂⁻¹ x. M̂ is factored.
  void solve_joint_inertia(Eigen::VectorXd& x) const;

  // ν̇ (6+n,) for torques tau (n,) and all other forces f (6+n,). M̂ is factored.
  void acceleration(const Eigen::Ref<const Eigen::VectorXd>& tau,
                    const Eigen::Ref<const Eigen::VectorXd>& force, Eigen::VectorXd& nu_dot);

 private:
  Eigen::LLT<Matrix6d> base_;
  Eigen::Matrix<double, Eigen::Dynamic, 6> coupling_;  // M_sb
  Eigen::Matrix<double, Eigen::Dynamic, 6> half_;      // M_sb L⁻ᵀ, M_bb = L Lᵀ
  Eigen::MatrixXd joint_inertia_;
  Eigen::MatrixXd factor_;  // of M̂: Cholesky's, or L and U where it is indefinite
  Eigen::VectorXi pivots_;
  Eigen::VectorXd joint_acceleration_;
  bool definite_ = true, factored_ = false;
};

}  // namespace codesign::dynamics
