#include "dynamics/flight/flight_measures.hpp"

#include <algorithm>
#include <cmath>

namespace codesign::dynamics {

FlightMeter::FlightMeter(Eigen::Index joints, const FuelRate& fuel) : fuel_(fuel) {
  for (Eigen::VectorXd* v : {&sums_.peak_torque, &sums_.peak_speed, &sums_.peak_power}) {
    v->setZero(joints);
  }
}

void FlightMeter::add(double dt, const Eigen::Vector3d& com_error, const Eigen::Vector3d& rpy_error,
                      double angle_error, const Eigen::Ref<const Eigen::VectorXd>& torque,
                      const Eigen::Ref<const Eigen::VectorXd>& velocity,
                      const Eigen::Ref<const Eigen::VectorXd>& thrust) {
  time_ += dt;
  com_square_ += dt * com_error.squaredNorm();
  attitude_square_ += dt * rpy_error.squaredNorm();
  pose_square_ += dt * (com_error.squaredNorm() + angle_error * angle_error);
  sums_.final_com_error = com_error.norm();
  sums_.max_com_error = std::max(sums_.max_com_error, sums_.final_com_error);
  sums_.max_attitude_error = std::max(sums_.max_attitude_error, rpy_error.norm());
  for (Eigen::Index j = 0; j < torque.size(); ++j) {
    const double power = torque[j] * velocity[j];
    sums_.mechanical_energy += dt * std::abs(power);
    sums_.positive_energy += dt * std::max(power, 0.0);
    sums_.peak_torque[j] = std::max(sums_.peak_torque[j], std::abs(torque[j]));
    sums_.peak_speed[j] = std::max(sums_.peak_speed[j], std::abs(velocity[j]));
    sums_.peak_power[j] = std::max(sums_.peak_power[j], std::abs(power));
  }
  const double total = thrust.sum();
  sums_.thrust_impulse += dt * total;
  sums_.fuel += dt * (static_cast<double>(thrust.size()) * fuel_.idle + fuel_.per_newton * total);
}

FlightMeasures FlightMeter::result() const {
  FlightMeasures measures = sums_;
  if (time_ > 0.0) {
    measures.com_error_rms = std::sqrt(com_square_ / time_);
    measures.attitude_error_rms = std::sqrt(attitude_square_ / time_);
    measures.pose_error_rms = std::sqrt(pose_square_ / time_);
  }
  return measures;
}

}  // namespace codesign::dynamics
