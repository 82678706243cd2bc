#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/flight_settings.hpp"

// What lies between the controllers' outputs and the robot.
namespace codesign::dynamics {

// Hands out what was put in a number of calls before. Before there is any such, the first.
class DelayLine {
 public:
  explicit DelayLine(int calls) : values_(static_cast<std::size_t>(calls) + 1) {}
  const Eigen::VectorXd& pass(const Eigen::VectorXd& value);

 private:
  std::vector<Eigen::VectorXd> values_;
  std::size_t next_ = 0;
  bool started_ = false;
};

// The joints' drives: wanted torque to acting torque, a whole number of periods late and behind a
// first-order lag, both held over a period of the torque loop. Starts in equilibrium.
class Drives {
 public:
  explicit Drives(const FlightSettings& settings);
  const Eigen::VectorXd& act(const Eigen::VectorXd& wanted);  // (joints) [N m]

 private:
  DelayLine delay_;
  double share_;  // of the difference that is made up in a period
  bool started_ = false;
  Eigen::VectorXd torque_;
};

// Friction torque of the drives at joint velocities (joints) [N m]; adds to joint_force (joints).
void add_friction(const Friction& friction, const Eigen::Ref<const Eigen::VectorXd>& joint_velocity,
                  Eigen::Ref<Eigen::VectorXd> joint_force);

}  // namespace codesign::dynamics
