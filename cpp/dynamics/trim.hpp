#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/actuator.hpp"
#include "dynamics/model.hpp"
#include "dynamics/spatial.hpp"

// Trim for hover: base attitude, joint angles and thrusts at which the actuators carry the weight
// and nothing turns. Of all such states the one nearest to a wanted one.
namespace codesign::dynamics {

// Between which angles joints may be.
struct JointRanges {
  Eigen::VectorXd lower, upper;  // (joints of the model) [rad, m]
};

// Which hover is sought.
struct TrimSettings {
  std::vector<std::string> joints;  // that may move; the others keep their angles
  // What is least at the trim: Σ (Δs / 1 rad)² + (tilt_weight · tilt)² + Σ (thrust_weight (T −
  // T̄))², T̄ the mean thrust.
  double tilt_weight = 3.0;      // [1/rad]
  double thrust_weight = 0.003;  // [1/N]
  double largest_step = 0.15;    // of a joint in one iteration [rad, m]
  double tolerance = 1e-9;       // of the residual [N, N m]
  int iterations = 200;          // at most
};

// A hover, or the nearest state to one that was found.
struct Trim {
  Pose base;                // the wanted one, tilted about its origin
  Eigen::VectorXd joints;   // (joints) inside their ranges
  Eigen::VectorXd thrusts;  // (actuators) inside their ranges [N]
  double residual = 0.0;    // largest entry of A T − (m g e₃; 0) [N, N m]
  int iterations = 0;
  bool reached = false;  // residual within the tolerance; else the robot cannot hover near here
};

// Gauss-Newton on the six balance equations, in each step the least weighted distance from the
// wanted state, bounds by freezing what would leave its range. A wanted angle outside its range
// counts as the range's end.
// Throws std::invalid_argument for a fixed base, wrong sizes or empty ranges, UnknownNameError for
// an unknown joint or frame.
Trim trim_hover(const Model& model, const std::vector<Actuator>& actuators, const Pose& base,
                const Eigen::Ref<const Eigen::VectorXd>& joints, const JointRanges& ranges,
                const TrimSettings& settings);

}  // namespace codesign::dynamics
