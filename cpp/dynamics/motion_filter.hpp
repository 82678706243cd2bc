#pragma once

#include <Eigen/Core>

namespace codesign::dynamics {

// Third-order low-pass that approximates a minimum-jerk motion, for three coordinates at once:
//   F(s) = a / (s³ + g s² + b s + a),  a = 150.765868956161/τ³, b = 84.9812819469538/τ²,
//   g = 15.9669610709384/τ,
// made discrete with Tustin's rule; value, velocity and acceleration are the outputs of F, sF, s²F.
// Its step response reaches 90 % near τ. Source of the coefficients: Pattacini et al., "An
// experimental evaluation of a novel minimum-jerk Cartesian controller for humanoid robots",
// IROS 2010.
class MotionFilter {
 public:
  struct Output {
    Eigen::Vector3d value, velocity, acceleration;
  };

  MotionFilter(double time, double step);  // τ and sampling step, both [s]

  // Output at this sample, newest input included. The first call sets the filter at rest there.
  const Output& update(const Eigen::Vector3d& input);

 private:
  double step_, a_, b_, g_, implicit_;
  Eigen::Vector3d third_derivative_ = Eigen::Vector3d::Zero();
  Output output_;
  bool started_ = false;
};

}  // namespace codesign::dynamics
