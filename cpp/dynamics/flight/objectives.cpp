#include "dynamics/flight/objectives.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace codesign::dynamics {

double spectral_norm(const Eigen::Ref<const Eigen::MatrixXd>& X) {
  const Eigen::MatrixXd gram = X.transpose() * X;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(eigen.eigenvalues().maxCoeff(), 0.0));
}

Eigen::MatrixXd reshaped_series(const History& series) {
  return Eigen::Map<const Eigen::MatrixXd>(series.data(), series.rows(), series.cols());
}

namespace {

// Measured minus commanded velocity of a group's joints (N, joints of the group) [rad/s].
History velocity_error(const FlightSettings& settings, const JointGroup& group,
                       const FlightLog& log) {
  History error(log.samples, static_cast<Eigen::Index>(group.joints.size()));
  for (std::size_t i = 0; i < group.joints.size(); ++i) {
    const auto found = std::find(settings.joints.begin(), settings.joints.end(), group.joints[i]);
    const Eigen::Index joint = found - settings.joints.begin();
    error.col(static_cast<Eigen::Index>(i)) =
        log.velocity.col(6 + joint) - log.joint_velocity_command.col(joint);
  }
  return error;
}

}  // namespace

void compute_objectives(const FlightSettings& settings, FlightLog& log) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  const double root_samples = std::sqrt(static_cast<double>(log.samples));
  const double thrust = log.thrust.sum() / static_cast<double>(log.samples);
  const Eigen::MatrixXd linear = log.momentum_error.leftCols<3>();
  const Eigen::MatrixXd angular = log.momentum_error.rightCols<3>();

  log.script_parts = {spectral_norm(linear), spectral_norm(angular), {}};
  log.rms_parts = {linear.norm() / root_samples, angular.norm() / root_samples, {}};
  log.script = {log.script_parts.angular_momentum + log.script_parts.linear_momentum, 0.0, thrust};
  log.rms = {log.rms_parts.linear_momentum + log.rms_parts.angular_momentum, 0.0, thrust};
  log.paper = {linear.colwise().sum().squaredNorm() + angular.colwise().sum().squaredNorm(), 0.0,
               thrust};
  for (const JointGroup& group : settings.groups) {
    const History error = velocity_error(settings, group, log);
    const double script = kDegrees * spectral_norm(reshaped_series(error));
    const double rms = error.norm() / root_samples;
    log.script_parts.joint_velocity.push_back(script);
    log.rms_parts.joint_velocity.push_back(rms);
    log.script.joint_velocity += group.weight * script;
    log.rms.joint_velocity += group.weight * rms;
    log.paper.joint_velocity += group.weight * error.colwise().sum().squaredNorm();
  }
}

}  // namespace codesign::dynamics
