#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "dynamics/momentum_controller.hpp"
#include "dynamics/plant.hpp"
#include "flying_robot.hpp"

namespace codesign::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

class MomentumControllerTest : public ::testing::Test {
 protected:
  MomentumControllerTest()
      : model_(testing::model()),
        settings_(testing::settings()),
        terms_(model_, settings_.actuators),
        task_(4, model_.joint_count()),
        qp_(settings_, model_.joint_count()) {
    state_.base.p = Vector3d(0.1, 0.2, 1.3);
    state_.base.R = exp_so3(Vector3d(0.1, -0.2, 2.5));
    state_.joints = vector(6, 0.5);
    state_.velocity = vector(12, 0.7);
    thrusts_ = VectorXd::Constant(4, 90.0) + 30.0 * vector(4, 1.0);
    RobotState start = state_;
    start.joints = vector(6, 0.3);
    update_terms(model_, start, terms_);
    origin_ = controller_origin(settings_, start, terms_);
    update_terms(model_, state_, terms_);
    reference_ = {vector(3, 1.0),
                  vector(3, 1.0),
                  vector(3, 1.0),
                  vector(3, 1.0),
                  exp_so3(Vector3d(0.2, 0.1, 2.7)),
                  vector(3, 0.5),
                  vector(3, 0.5),
                  vector(3, 0.5)};
    build_momentum_task(model_, settings_, origin_, state_, terms_, thrusts_, reference_,
                        Vector6d::Zero(), task_);
    build_momentum_qp(settings_, origin_, task_, state_, thrusts_, qp_);
  }

  VectorXd vector(Eigen::Index n, double size) {
    std::uniform_real_distribution<double> uniform(-size, size);
    return VectorXd::NullaryExpr(n, [&] { return uniform(random_); });
  }

  // The cost of u as the specification writes it.
  double cost(const VectorXd& u) const {
    const Weights& w = settings_.weights;
    const VectorXd T = u.head(4), s_dot = u.tail(6);
    const Eigen::Matrix<double, kTaskRows, 1> e = task_.rows * u + task_.offset;
    const VectorXd pull =
        s_dot + settings_.gains.posture.cwiseProduct(state_.joints - origin_.posture);
    return 0.5 * (w.momentum * e.head<6>().squaredNorm() +
                  w.constant_inertia * e.tail<3>().squaredNorm() + w.posture * pull.squaredNorm() +
                  w.joint_velocity * s_dot.squaredNorm() + w.thrust_rate * T.squaredNorm() +
                  w.thrust_symmetry * (std::pow(T[0] - T[1], 2) + std::pow(T[2] - T[3], 2)) +
                  w.regularization * u.squaredNorm());
  }

  std::mt19937_64 random_{5};
  Model model_;
  FlightSettings settings_;
  RobotState state_;
  RobotTerms terms_;
  VectorXd thrusts_;
  ControllerOrigin origin_;
  Reference reference_;
  MomentumTask task_;
  MomentumQp qp_;
};

TEST_F(MomentumControllerTest, QpIsTheCostOfTheSpecification) {
  const Eigen::MatrixXd H = qp_.objective.hessian();
  const double constant = cost(VectorXd::Zero(10));
  for (int trial = 0; trial < 10; ++trial) {
    VectorXd u = vector(10, 1.0);
    u.head(4) *= 100.0;
    const double direct = cost(u) - constant;
    const double quadratic = 0.5 * u.dot(H * u) + qp_.objective.linear().dot(u);
    EXPECT_NEAR(direct, quadratic, 1e-10 * std::abs(cost(u)));
  }
  EXPECT_EQ(H, H.transpose());
}

TEST_F(MomentumControllerTest, LinearTaskIsTheErrorOfTheMomentumLaw) {
  const VectorXd u = vector(10, 10.0);
  VectorXd nu = state_.velocity;
  nu.tail(6) = u.tail(6);  // the law predicts the momentum with the commanded joint velocities
  Matrix6Xd A(6, 4), Lambda(6, 12);
  jet_map(terms_, A);
  jet_map_rate(model_, terms_, thrusts_, Lambda);
  const double m = terms_.robot.mass;
  const Vector3d acceleration = (A * u.head(4) + Lambda * nu).head<3>();
  const Vector3d rate = (A * thrusts_).head<3>() - Vector3d(0.0, 0.0, m * kGravity);
  const Vector3d momentum = (terms_.momentum_matrix * nu).head<3>();
  const Vector3d error = acceleration - m * reference_.jerk +
                         4.061862178478973 * (rate - m * reference_.acceleration) +
                         4.661862178478973 * (momentum - m * reference_.velocity) +
                         1.5 * m * (terms_.com - reference_.position);
  const Vector3d task = (task_.rows * u + task_.offset).head<3>();
  EXPECT_LT((task - error).norm(), 1e-10 * error.norm());
}

// σ collects what the rotating base adds: with L the angular momentum in base axes, of the frozen
// inertia I₀, L̈ = Rᵀẅ − σ.
TEST_F(MomentumControllerTest, AngularTaskAsksForTheAttitudeLaw) {
  const VectorXd u = vector(10, 10.0);
  VectorXd nu = state_.velocity;
  nu.tail(6) = u.tail(6);
  Matrix6Xd A(6, 4), Lambda(6, 12);
  jet_map(terms_, A);
  jet_map_rate(model_, terms_, thrusts_, Lambda);
  const Matrix3d R = state_.base.R, I = origin_.base_inertia, I_inverse = I.inverse();
  const Vector3d omega = R.transpose() * state_.velocity.segment<3>(3);
  const Vector3d w_dot = (A * thrusts_).tail<3>();
  const Vector3d w_ddot = (A * u.head(4) + Lambda * nu).tail<3>();
  const Vector3d L = I * omega;
  const Vector3d L_dot = R.transpose() * w_dot - omega.cross(L);
  const Vector3d omega_dot = I_inverse * L_dot;
  const Vector3d L_ddot = R.transpose() * w_ddot - omega.cross(R.transpose() * w_dot) -
                          omega_dot.cross(L) - omega.cross(L_dot);
  const Matrix3d R_e = reference_.rotation.transpose() * R;
  const Vector3d e = skew_part(R_e);
  const double h = 1e-6;  // both frames turn: ė by differences
  const Matrix3d ahead =
      (reference_.rotation * exp_so3(h * reference_.angular_velocity)).transpose() * R *
      exp_so3(h * omega);
  const Matrix3d behind =
      (reference_.rotation * exp_so3(-h * reference_.angular_velocity)).transpose() * R *
      exp_so3(-h * omega);
  const Vector3d e_dot = (skew_part(ahead) - skew_part(behind)) / (2.0 * h);
  const double c0 = 50.0, c1 = 2.0 * std::sqrt(50.0);
  const Vector3d rate_error = L_dot - I * reference_.angular_acceleration;
  const Vector3d wanted = I * reference_.angular_jerk - e_dot - rate_error -
                          c0 * (I_inverse * rate_error) - c0 * (I_inverse * e) -
                          c1 * (I_inverse * (L - I * reference_.angular_velocity));
  const Vector3d task = (task_.rows * u + task_.offset).segment<3>(3);
  EXPECT_LT((task - (L_ddot - wanted)).norm(), 1e-7 * task.norm());
}

TEST_F(MomentumControllerTest, BoundsDriveBackIntoTheRanges) {
  state_.joints.setZero();
  state_.joints[0] = 1.2;  // above its range of ±1
  thrusts_ << 0.0, 250.0, 251.0, 100.0;
  build_momentum_qp(settings_, origin_, task_, state_, thrusts_, qp_);
  EXPECT_EQ(qp_.lower[0], 0.0);
  EXPECT_EQ(qp_.upper[1], 0.0);
  EXPECT_LT(qp_.upper[2], 0.0);
  EXPECT_NEAR(qp_.upper[3], 200.0, 1e-12);
  EXPECT_LT(qp_.upper[4], 0.0);
  EXPECT_TRUE((qp_.lower.array() <= qp_.upper.array()).all());
}

}  // namespace
}  // namespace codesign::dynamics
