#include "dynamics/torque_controller.hpp"

#include "dynamics/dense_kernels.hpp"

namespace codesign::dynamics {

namespace {

// ‖ε M̂²‖ up to which the system counts as near the identity. A step of conjugate gradients then
// leaves a fortieth of the error at most, so that kMostSteps end with kSolved, a residual of a few
// roundings of the right-hand side.
constexpr double kNearIdentity = 0.1;
constexpr int kMostSteps = 10;
constexpr double kSolved = 0x1p-48;

}  // namespace

TorqueController::TorqueController(const FlightSettings& settings)
    : step_(settings.step / settings.torque_updates),
      proportional_(settings.gains.torque_proportional),
      integral_(settings.gains.torque_integral),
      weight_(settings.weights.torque),
      limit_(settings.limits.torque),
      rate_limit_(settings.limits.torque_rate),
      used_once_(settings.torque_updates == 1 || !settings.hold_inertia),
      solver_(static_cast<int>(settings.joints.size())) {
  const auto n = static_cast<Eigen::Index>(settings.joints.size());
  for (Eigen::VectorXd* v :
       {&error_integral_, &velocity_error_, &right_side_, &solution_, &torque_, &gradient_,
        &half_product_, &product_, &residual_, &direction_, &last_solution_, &last_right_side_}) {
    v->setZero(n);
  }
  for (Eigen::MatrixXd* m : {&system_, &inverse_, &hessian_}) m->setZero(n, n);
  lower_.setConstant(n, -limit_);
  upper_.setConstant(n, limit_);
}

// Minimize ½|W τ + s̈₀ − s̈*|² + ½ε|τ|² with W = M̂⁻¹ and s̈₀ = W f̂. Multiplied by M̂², the normal
// equations (W² + εI) τ = W (s̈* − s̈₀) become (I + ε M̂²) τ = M̂ s̈* − f̂: no inverse, and a condition
// number close to one, also where M̂ is nearly singular or indefinite. Where it is very close to one
// and the matrix is used once, conjugate gradients need less than a factorization.
bool TorqueController::renew(const JointSpace& joint_space) {
  const Eigen::MatrixXd& inertia = joint_space.joint_inertia();
  const int n = static_cast<int>(inertia.rows());
  if (n == 0) return true;
  const double norm = inertia.cwiseAbs().colwise().sum().maxCoeff();
  factored_ = !(used_once_ && weight_ * norm * norm < kNearIdentity);
  if (!factored_) return true;
  system_.setIdentity();
  add_outer_product(system_.data(), n, n, inertia.data(), n, n, weight_);
  return cholesky_in_place(system_.data(), n, n);
}

// solution_ = (I + ε M̂²)⁻¹ right_side_, by conjugate gradients from the last solution moved by what
// the right side changed.
void TorqueController::solve_near_identity(const Eigen::MatrixXd& inertia) {
  const int n = static_cast<int>(inertia.rows());
  const auto add_square = [&](const Eigen::VectorXd& x) {  // product_ = ε M̂² x
    half_product_.setZero();
    add_product(inertia.data(), n, n, n, x.data(), half_product_.data());
    half_product_ *= weight_;
    product_.setZero();
    add_product(inertia.data(), n, n, n, half_product_.data(), product_.data());
  };
  solution_ = last_solution_ + right_side_ - last_right_side_;
  add_square(solution_);
  residual_ = right_side_ - solution_ - product_;
  direction_ = residual_;
  double square = residual_.squaredNorm();
  const double enough = kSolved * kSolved * right_side_.squaredNorm();
  for (int i = 0; i < kMostSteps && square > enough; ++i) {
    add_square(direction_);
    product_ += direction_;
    const double length = square / direction_.dot(product_);
    solution_ += length * direction_;
    residual_ -= length * product_;
    const double next = residual_.squaredNorm();
    direction_ = residual_ + (next / square) * direction_;
    square = next;
  }
  last_solution_ = solution_;
  last_right_side_ = right_side_;
}

QpStatus TorqueController::update(JointSpace& joint_space,
                                  const Eigen::Ref<const Eigen::VectorXd>& joint_force,
                                  const Eigen::Ref<const Eigen::VectorXd>& joint_velocity,
                                  const Eigen::Ref<const Eigen::VectorXd>& commanded_velocity) {
  if (!renew(joint_space)) return QpStatus::kNotPositiveDefinite;
  return follow(joint_space, joint_force, joint_velocity, commanded_velocity);
}

QpStatus TorqueController::follow(JointSpace& joint_space,
                                  const Eigen::Ref<const Eigen::VectorXd>& joint_force,
                                  const Eigen::Ref<const Eigen::VectorXd>& joint_velocity,
                                  const Eigen::Ref<const Eigen::VectorXd>& commanded_velocity) {
  const Eigen::MatrixXd& inertia = joint_space.joint_inertia();
  const int n = static_cast<int>(inertia.rows());
  if (n == 0) return QpStatus::kSolved;  // no joints, no torques
  velocity_error_ = joint_velocity - commanded_velocity;
  solution_ = -proportional_ * velocity_error_ - integral_ * error_integral_;
  error_integral_ += step_ * velocity_error_;
  right_side_ = -joint_force;
  add_product(inertia.data(), n, n, n, solution_.data(), right_side_.data());
  iterations_ = 1;
  if (factored_) {
    solution_ = right_side_;
    cholesky_solve(system_.data(), n, n, solution_.data());
  } else {
    solve_near_identity(inertia);
  }
  if (!solution_.allFinite()) return QpStatus::kBadData;
  if (solution_.cwiseAbs().maxCoeff() > limit_) {
    const QpStatus status = solve_within_limits(joint_space);
    if (status != QpStatus::kSolved) return status;
  }

  if (!started_) {
    started_ = true;
    torque_ = solution_;
  }
  const double change = rate_limit_ * step_;
  torque_ += (solution_ - torque_).cwiseMax(-change).cwiseMin(change);
  return QpStatus::kSolved;
}

// The same problem with its limits, on the explicit W: (W² + εI), −W² right_side.
QpStatus TorqueController::solve_within_limits(JointSpace& joint_space) {
  if (!joint_space.factor()) return QpStatus::kNotPositiveDefinite;
  const int n = static_cast<int>(inverse_.rows());
  for (Eigen::Index j = 0; j < n; ++j) {
    gradient_.setZero();
    gradient_[j] = 1.0;
    joint_space.solve_joint_inertia(gradient_);
    inverse_.col(j) = gradient_;
  }
  hessian_.setZero();
  hessian_.diagonal().setConstant(weight_);
  add_outer_product(hessian_.data(), n, n, inverse_.data(), n, n, 1.0);
  hessian_.triangularView<Eigen::StrictlyUpper>() = hessian_.transpose();
  gradient_ = -right_side_;
  joint_space.solve_joint_inertia(gradient_);
  joint_space.solve_joint_inertia(gradient_);
  const BoxQpResult& result = solver_.solve(hessian_, gradient_, lower_, upper_);
  iterations_ += result.iterations;
  solution_ = result.x;
  return result.status;
}

}  // namespace codesign::dynamics
