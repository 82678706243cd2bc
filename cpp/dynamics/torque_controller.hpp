#pragma once

#include <Eigen/Core>

#include "dynamics/flight_settings.hpp"
#include "dynamics/joint_space.hpp"
#include "dynamics/qp/box_qp.hpp"

namespace codesign::dynamics {

// Joint torques that make the joint velocities follow their commands: a PI law for the joint
// accelerations, the torques by regularized least squares within their limits, then a rate limiter.
class TorqueController {
 public:
  explicit TorqueController(const FlightSettings& settings);

  // joint_force: f̂ of everything but the torques. Returns the status of the torque QP.
  QpStatus update(JointSpace& joint_space, const Eigen::Ref<const Eigen::VectorXd>& joint_force,
                  const Eigen::Ref<const Eigen::VectorXd>& joint_velocity,
                  const Eigen::Ref<const Eigen::VectorXd>& commanded_velocity);

  // The two halves of it: renew() takes the joint-space inertia into the least squares, false if
  // that is not positive definite; follow() may be called again with the inertia taken last.
  bool renew(const JointSpace& joint_space);
  QpStatus follow(JointSpace& joint_space, const Eigen::Ref<const Eigen::VectorXd>& joint_force,
                  const Eigen::Ref<const Eigen::VectorXd>& joint_velocity,
                  const Eigen::Ref<const Eigen::VectorXd>& commanded_velocity);

  const Eigen::VectorXd& torque() const { return torque_; }  // of the last update (n,) [Nm]
  int iterations() const { return iterations_; }             // linear systems solved in it

 private:
  void solve_near_identity(const Eigen::MatrixXd& inertia);
  QpStatus solve_within_limits(JointSpace& joint_space);

  double step_, proportional_, integral_, weight_, limit_, rate_limit_;
  bool used_once_;  // every inertia, between two calls of renew()
  bool started_ = false;
  bool factored_ = false;
  int iterations_ = 0;
  Eigen::VectorXd error_integral_, velocity_error_, right_side_, solution_, torque_;
  // Of conjugate gradients.
  Eigen::VectorXd half_product_, product_, residual_, direction_, last_solution_, last_right_side_;
  Eigen::MatrixXd system_;  // factored, else
  // For the bounded problem.
  BoxQpSolver solver_;
  Eigen::MatrixXd inverse_, hessian_;
  Eigen::VectorXd gradient_, lower_, upper_;
};

}  // namespace codesign::dynamics
