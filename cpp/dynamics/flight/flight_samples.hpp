#pragma once

#include <chrono>
#include <vector>

#include "dynamics/flight/flight_log.hpp"
#include "dynamics/flight_settings.hpp"
#include "dynamics/robot_terms.hpp"

// What the flights of all controllers share in writing their log.
namespace codesign::dynamics {

// Adds the time since the last call to one phase after the other.
class Stopwatch {
 public:
  void lap(double& phase) {
    const Clock::time_point now = Clock::now();
    phase += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

// The contact points of the settings, resolved to their frames.
class PointHeights {
 public:
  PointHeights(const Model& model, const FlightSettings& settings);
  // Of the lowest point above the ground [m]; infinity without points.
  double lowest(const RobotTerms& terms) const;

 private:
  struct Point {
    int body;
    Eigen::Vector3d position;  // in the body [m]
  };
  std::vector<Point> points_;
  double ground_height_;
};

// R in a history of rotations, row after row.
void write_rotation(const Eigen::Matrix3d& R, History& history, int k);
Eigen::Matrix3d read_rotation(const History& history, int k);

// Sum of the pulses that act in a step which starts at `time`, up to rounding.
struct PulseSum {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // on the base, through the center of mass [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // on the base [N m]
};
PulseSum pulses_at(const std::vector<Pulse>& pulses, double time);

// Sample k of base, joints, velocity, center of mass and momentum; makes it the last sample.
void log_state(const RobotState& state, const RobotTerms& terms, int k, FlightLog& log);

// Ends a flight as failed.
void set_failure(FailureReason reason, double time, FlightLog& log);

// 1 − max T_i / thrust_max_i over the actuators: what hovering leaves of the weakest one.
double hover_margin(const std::vector<Actuator>& actuators,
                    const Eigen::Ref<const Eigen::VectorXd>& thrusts);

}  // namespace codesign::dynamics
