#pragma once

#include <Eigen/Core>

#include "dynamics/actuator.hpp"

namespace codesign::dynamics {

// Tracking, energy and fuel of a flight. Integrals are left sums.
struct FlightMeasures {
  double com_error_rms = 0.0;       // [m]
  double attitude_error_rms = 0.0;  // norm of the roll, pitch and yaw errors [rad]
  double pose_error_rms = 0.0;  // of √(|CoM error|² + (1 m · angle of the error's rotation)²)
  double max_com_error = 0.0;   // [m]
  double max_attitude_error = 0.0;  // norm of the roll, pitch and yaw errors [rad]
  double final_com_error = 0.0;     // [m]
  double mechanical_energy = 0.0;   // Σ ∫ |τ ṡ| dt [J], no recuperation
  double positive_energy = 0.0;     // Σ ∫ max(τ ṡ, 0) dt [J]
  double fuel = 0.0;                // [kg]
  double thrust_impulse = 0.0;      // Σ ∫ T dt [N s]
  double hover_margin = 0.0;        // 1 − largest share of its limit that an initial thrust takes
  Eigen::VectorXd peak_torque;      // (joints) [N m]
  Eigen::VectorXd peak_speed;       // (joints) [rad/s]
  Eigen::VectorXd peak_power;       // (joints) [W]
};

// Sums up what a flight shows at every step.
class FlightMeter {
 public:
  FlightMeter(Eigen::Index joints, const FuelRate& fuel);

  // One step of length dt [s] from a state: errors of center of mass, of roll, pitch and yaw, and
  // of the rotation as an angle [rad]; torques, joint velocities (joints), thrusts (jets).
  void add(double dt, const Eigen::Vector3d& com_error, const Eigen::Vector3d& rpy_error,
           double angle_error, const Eigen::Ref<const Eigen::VectorXd>& torque,
           const Eigen::Ref<const Eigen::VectorXd>& velocity,
           const Eigen::Ref<const Eigen::VectorXd>& thrust);

  FlightMeasures result() const;

 private:
  FuelRate fuel_;
  double time_ = 0.0;
  double com_square_ = 0.0, attitude_square_ = 0.0, pose_square_ = 0.0;
  FlightMeasures sums_;
};

}  // namespace codesign::dynamics
