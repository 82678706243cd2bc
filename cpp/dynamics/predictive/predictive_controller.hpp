#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/predictive/condensed_qp.hpp"
#include "dynamics/qp/box_qp.hpp"
#include "dynamics/waypoints.hpp"

namespace codesign::dynamics {

// Multi-rate predictive control: every solve moves the set points of its joints, every n-th one
// also the throttles, which are held between. Allocates only in its constructor and in start().
class PredictiveController {
 public:
  // Throws as PredictionModelBuilder and Path do.
  PredictiveController(const Model& model, const FlightSettings& settings);

  // Begins at a state: the path counts from its center of mass and attitude, the throttles hold
  // its thrusts, the set points (joints of the model) [rad] are home.
  void start(const RobotTerms& terms, const std::vector<ThrustState>& jets,
             const Eigen::VectorXd& set_points);

  // The k-th solve, at time k · period. Moves set points and throttles if it is solved.
  QpStatus solve(int k, const RobotTerms& terms, const std::vector<ThrustState>& jets);

  const Eigen::VectorXd& set_points() const { return set_points_; }  // (joints of the model) [rad]
  const Eigen::VectorXd& set_point_rate() const { return set_point_rate_; }  // of the last solve
  const Eigen::VectorXd& throttles() const { return throttles_; }            // (jets) [%]
  const Eigen::VectorXd& variables() const { return task_.variable; }  // (jets) of the throttles

  // Replaces what start() chose: throttle variables that act (jets).
  void set_variables(const Eigen::VectorXd& variables);

  // Position and yaw of the path with its derivatives, from the start.
  PathPoint path_point(double time) const { return path_.at(time); }
  Eigen::Vector3d com_reference(double time) const;
  Eigen::Vector3d rpy_reference(double time) const;

  // Roll, pitch and yaw of the body, near those of the last solve.
  Eigen::Vector3d body_rpy(const RobotTerms& terms) const {
    return builder_.body_rpy(terms, last_rpy_);
  }

  const PredictionState& state() const { return task_.state; }  // of the last solve
  const PredictionModel& prediction() const { return prediction_; }
  const PredictionModelBuilder& builder() const { return builder_; }
  const CondensedQp& qp() const { return qp_; }
  const Eigen::VectorXd& lower() const { return lower_; }
  const Eigen::VectorXd& upper() const { return upper_; }
  const BoxQpResult& result() const { return solver_.result(); }

 private:
  PredictionReference reference_at(double time) const;
  void set_integrals();
  void set_bounds(bool throttle_update);
  void apply(bool throttle_update);

  const Model& model_;
  PredictiveSettings settings_;
  PredictionModelBuilder builder_;
  PredictionModel prediction_;
  Path path_;
  CondensedQp qp_;
  PredictionTask task_;
  BoxQpSolver solver_;
  Eigen::VectorXd lower_, upper_;
  Eigen::VectorXd home_, set_points_, set_point_rate_, throttles_;
  Eigen::Vector3d com_start_, rpy_start_, last_rpy_;
  Eigen::Vector3d com_error_sum_, rpy_error_sum_;
};

}  // namespace codesign::dynamics
