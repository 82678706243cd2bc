#include "dynamics/motion_filter.hpp"

#include <stdexcept>

namespace codesign::dynamics {

namespace {

// Coefficients in z⁻¹ of (1−z⁻¹)^p (1+z⁻¹)^(3−p): what s^p becomes, up to (2/h)^p.
constexpr double kTustin[4][4] = {
    {1.0, 3.0, 3.0, 1.0}, {1.0, 1.0, -1.0, -1.0}, {1.0, -1.0, -1.0, 1.0}, {1.0, -3.0, 3.0, -1.0}};

void shift(Eigen::Vector3d (&past)[3], const Eigen::Vector3d& newest) {
  past[2] = past[1];
  past[1] = past[0];
  past[0] = newest;
}

}  // namespace

MotionFilter::MotionFilter(double time, double step) {
  if (!(time > 0.0) || !(step > 0.0)) {
    throw std::invalid_argument("MotionFilter: time and step must be positive");
  }
  const double a = 150.765868956161 / (time * time * time);
  const double b = 84.9812819469538 / (time * time);
  const double g = 15.9669610709384 / time;
  const double c = 2.0 / step;
  for (int i = 0; i < 4; ++i) {
    a_[i] = a * kTustin[0][i] + b * c * kTustin[1][i] + g * c * c * kTustin[2][i] +
            c * c * c * kTustin[3][i];
  }
  for (int i = 0; i < 4; ++i) {
    value_.b[i] = a * kTustin[0][i] / a_[0];
    velocity_.b[i] = a * c * kTustin[1][i] / a_[0];
    acceleration_.b[i] = a * c * c * kTustin[2][i] / a_[0];
  }
  for (int i = 3; i >= 0; --i) a_[i] /= a_[0];
}

Eigen::Vector3d MotionFilter::filtered(const Channel& channel, const Eigen::Vector3d& input) const {
  Eigen::Vector3d y = channel.b[0] * input;
  for (int i = 1; i < 4; ++i) {
    y += channel.b[i] * past_input_[i - 1] - a_[i] * channel.past[i - 1];
  }
  return y;
}

const MotionFilter::Output& MotionFilter::update(const Eigen::Vector3d& input) {
  if (!started_) {
    started_ = true;
    for (int i = 0; i < 3; ++i) {
      past_input_[i] = value_.past[i] = input;
      velocity_.past[i].setZero();
      acceleration_.past[i].setZero();
    }
  }
  output_ = {filtered(value_, input), filtered(velocity_, input), filtered(acceleration_, input)};
  shift(value_.past, output_.value);
  shift(velocity_.past, output_.velocity);
  shift(acceleration_.past, output_.acceleration);
  shift(past_input_, input);
  return output_;
}

}  // namespace codesign::dynamics
