#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/flight_settings.hpp"
#include "dynamics/joint_space.hpp"
#include "dynamics/robot_terms.hpp"

namespace codesign::dynamics {

// Held over a control period.
struct ServoInputs {
  Eigen::VectorXd set_points;                            // (joints) [rad]
  Eigen::VectorXd throttles;                             // (jets) commands of the actuators
  Eigen::Vector3d base_force = Eigen::Vector3d::Zero();  // on the base's origin, world axes [N]
  Eigen::Vector3d com_force =
      Eigen::Vector3d::Zero();  // on the base, through the center of mass [N]
  Eigen::Vector3d base_moment = Eigen::Vector3d::Zero();  // on the base, world axes [N m]
};

// A flying robot whose joints follow position servos, with its jets.
class ServoPlant {
 public:
  ServoPlant(const Model& model, const FlightSettings& settings);

  // Damping of the servos from the mass matrix at this state; returns the set points (joints) at
  // which the joints stay at rest under the jets' thrusts.
  Eigen::VectorXd start(const RobotState& state, const std::vector<ThrustState>& jets);

  // Terms of the plant and torques of the servos at a state, before a step is made from it.
  // False if the mass matrix is singular or not finite.
  bool evaluate(const RobotState& state, const std::vector<ThrustState>& jets,
                const ServoInputs& inputs);
  const RobotTerms& terms() const { return terms_; }
  const Eigen::VectorXd& torque() const { return torque_; }    // (joints) [N m]
  const Eigen::VectorXd& damping() const { return damping_; }  // k_d (joints) [N m s/rad]

  // One plant step on from the evaluated state.
  bool advance(const ServoInputs& inputs, double step, RobotState& state,
               std::vector<ThrustState>& jets);

 private:
  void servo_torque(const RobotState& state, const ServoInputs& inputs);
  void sum_forces(const std::vector<ThrustState>& jets, const ServoInputs& inputs);
  bool implicit_step(const ServoInputs& inputs, double step, RobotState& state);
  bool runge_kutta(const ServoInputs& inputs, double step, RobotState& state,
                   std::vector<ThrustState>& jets);

  Model model_;
  ServoPlantSettings settings_;
  std::vector<Actuator> actuators_;
  Eigen::VectorXd thrust_scale_, damping_;
  RobotTerms terms_;
  JointSpace joint_space_;
  Eigen::MatrixXd mass_matrix_;
  Eigen::VectorXd torque_, thrust_, force_, nu_dot_;
  RobotState stage_, origin_;
  std::vector<ThrustState> jet_origin_, jet_rate_, jet_sum_;
  Eigen::VectorXd rate_, rate_sum_, acceleration_sum_;
};

}  // namespace codesign::dynamics
