#pragma once

#include <Eigen/Core>
#include <optional>

#include "dynamics/drag.hpp"
#include "dynamics/flight_settings.hpp"
#include "dynamics/joint_space.hpp"
#include "dynamics/paired/jet_mounts.hpp"
#include "dynamics/paired/paired_bodies.hpp"
#include "dynamics/robot_terms.hpp"

namespace codesign::dynamics {

// Held over one period of the torque loop.
struct PlantInputs {
  Eigen::VectorXd torque;      // (joints) [Nm]
  Eigen::VectorXd thrust;      // (jets) [N], as commanded: errors of the jets are the plant's
  Eigen::Vector3d base_force;  // on the base's origin, world axes [N]
  Eigen::Vector3d com_force =
      Eigen::Vector3d::Zero();  // on the base, through the center of mass [N]
  Eigen::Vector3d base_moment = Eigen::Vector3d::Zero();  // on the base, world axes [N m]
};

// The flying robot: advances a state by one period of the torque loop under held inputs.
class Plant {
 public:
  Plant(const Model& model, const FlightSettings& settings);

  // terms and joint_space are those of the undisturbed robot at `state`. If the plant has the
  // model's masses, the first stage is made with them, and the bodies of the terms are used up;
  // else with the motion of these bodies. False if the mass matrix is singular or not finite.
  bool advance(RobotTerms& terms, JointSpace& joint_space, const PlantInputs& inputs,
               RobotState& state);

  // The same without terms. moved: the undisturbed robot moved to `state`, if it is there already.
  bool advance(const PlantInputs& inputs, RobotState& state, const PairedBodies* moved = nullptr);

  double fuel_left() const { return fuel_; }  // [kg]; negative: more was burnt than there was

 private:
  bool acceleration(const RobotState& state, const PlantInputs& inputs,
                    const PairedBodies* moved = nullptr);
  bool by_articulated_bodies(const RobotState& state, const PlantInputs& inputs,
                             const PairedBodies* moved);
  bool accelerate(PairedBodies& bodies, const RobotState& state, const PlantInputs& inputs);
  void acceleration(const RobotState& state, const RobotTerms& terms, JointSpace& joint_space,
                    const PlantInputs& inputs);
  bool substep(const PlantInputs& inputs, RobotState& state);
  bool runge_kutta(const PlantInputs& inputs, RobotState& state);
  void fill_tank(const Tank& tank);
  void burn();

  Model model_;
  Drag drag_;
  Friction friction_;
  // The tank's body with all fuel, where the fuel is in its axes, and what is left of it.
  int tank_body_ = kNone;
  RigidInertia full_;
  Eigen::Vector3d fuel_position_ = Eigen::Vector3d::Zero();
  double fuel_ = 0.0, tank_size_ = 0.0, consumption_ = 0.0;
  Integrator integrator_;
  int substeps_;
  double step_;  // of one substep [s]
  double rotation_deadband_;
  bool has_model_masses_;
  Eigen::VectorXd thrust_scale_, thrust_, torque_, force_, nu_dot_;
  std::vector<JetMount> jets_;
  std::optional<PairedBodies> bodies_;  // where no bodies share a joint
  RobotTerms terms_;                    // else
  JointSpace joint_space_;
  RobotState stage_, origin_;
  Eigen::VectorXd rate_, rate_sum_, acceleration_sum_;
};

// q ⊕ displacement: positions add, the rotation vector (world axes) turns the base.
void displace(const Eigen::Ref<const Eigen::VectorXd>& displacement, RobotState& state);

// Rate of the rotation vector θ in R = Exp(θ) R₀ when R turns with ω: the inverse of the
// exponential's differential, to fourth order in θ.
Eigen::Vector3d rotation_vector_rate(const Eigen::Vector3d& theta, const Eigen::Vector3d& omega);

}  // namespace codesign::dynamics
