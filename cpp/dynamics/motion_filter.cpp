#include "dynamics/motion_filter.hpp"

#include <stdexcept>

namespace codesign::dynamics {

MotionFilter::MotionFilter(double time, double step) : step_(step) {
  if (!(time > 0.0) || !(step > 0.0)) {
    throw std::invalid_argument("MotionFilter: time and step must be positive");
  }
  a_ = 150.765868956161 / (time * time * time);
  b_ = 84.9812819469538 / (time * time);
  g_ = 15.9669610709384 / time;
  const double half = 0.5 * step;
  implicit_ = 1.0 + half * (g_ + half * (b_ + half * a_));
}

// Tustin's rule is the trapezoidal rule on x⃛ = a (input − x) − b ẋ − g ẍ. It is implicit in the new
// x⃛ only, so it is solved for that. Unlike a difference equation of third order, whose poles crowd
// near one, this form does not amplify round-off.
const MotionFilter::Output& MotionFilter::update(const Eigen::Vector3d& input) {
  if (!started_) {
    started_ = true;
    output_ = {input, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  }
  const double half = 0.5 * step_;
  const Output& last = output_;
  const Eigen::Vector3d acceleration = last.acceleration + half * third_derivative_;
  const Eigen::Vector3d velocity = last.velocity + half * (last.acceleration + acceleration);
  const Eigen::Vector3d value = last.value + half * (last.velocity + velocity);
  third_derivative_ = (a_ * (input - value) - b_ * velocity - g_ * acceleration) / implicit_;
  output_.acceleration = acceleration + half * third_derivative_;
  output_.velocity = velocity + half * half * third_derivative_;
  output_.value = value + half * half * half * third_derivative_;
  return output_;
}

}  // namespace codesign::dynamics
