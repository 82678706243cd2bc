#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/actuator.hpp"
#include "dynamics/centroidal.hpp"
#include "dynamics/paired/paired_bodies.hpp"
#include "dynamics/rigid_body.hpp"

namespace codesign::dynamics {

// Configuration and velocity of a floating-base robot, mixed convention (model.hpp).
struct RobotState {
  Pose base;
  Eigen::VectorXd joints;    // (n,)
  Eigen::VectorXd velocity;  // (6 + n,)
};

// An actuator on the robot: its frame, the bodies it pushes (from its own down to, not including,
// the base), and where it is at the present state; world axes.
struct MountedActuator {
  int frame = 0;
  std::vector<int> chain;
  Eigen::Vector3d frame_axis = Eigen::Vector3d::Zero();  // in the frame
  double reaction = 0.0;                                 // moment about the axis per thrust [m]
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();        // unit vector along which thrust pushes
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();      // from the base origin [m]
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();         // from the center of mass [m]
};

// All that a control step needs to know of the robot at one state. Allocated once; written by
// update_terms.
struct RobotTerms {
  // rotor_inertia: (joints) of the drives at their joints [kg m²]; empty: none.
  RobotTerms(const Model& model, const std::vector<Actuator>& actuators,
             Eigen::VectorXd rotor_inertia = {});

  KinematicsData kin;
  RigidInertia robot;           // as one body; center of mass from the base origin, world axes
  Eigen::MatrixXd mass_matrix;  // M (6+n, 6+n), rotors included
  Eigen::VectorXd bias;         // b (6+n,)
  Matrix6Xd momentum_matrix;    // C (6, 6+n)
  Vector6d momentum;            // (l; w) about the center of mass
  Eigen::Vector3d com;          // in the world [m]
  std::vector<MountedActuator> jets;

  // What the terms are made with: bodies two at a time, or one by one where the base is fixed or
  // bodies share a joint.
  struct Singly {
    explicit Singly(const Model& model);
    VelocityData velocity;
    InertiaData inertia;
    ForceData forces;
    Eigen::VectorXd rotor_inertia;
  };
  std::optional<PairedBodies> paired;
  std::optional<Singly> singly;
};

// Writes all terms of a state.
void update_terms(const Model& model, const RobotState& state, RobotTerms& terms);

// All but the momentum: what the equations of motion need.
void update_motion_terms(const Model& model, const RobotState& state, RobotTerms& terms);

// Velocity of a body's origin [m/s] and its angular velocity [rad/s], world axes.
struct BodyTwist {
  Eigen::Vector3d linear, angular;
};
BodyTwist body_twist(const RobotTerms& terms, int body);

// generalized (6+n,) += Jᵀ force at a point of a body; point from the base origin, world axes.
void add_point_force(const Model& model, const KinematicsData& kin, int body,
                     const Eigen::Vector3d& point, const Eigen::Vector3d& force,
                     Eigen::Ref<Eigen::VectorXd> generalized);

// generalized (6+n,) += Σ Jᵢᵀ (aᵢ; reactionᵢ aᵢ) Tᵢ for the thrusts T (jets,) [N].
void add_jet_forces(const Model& model, const RobotTerms& terms,
                    const Eigen::Ref<const Eigen::VectorXd>& thrusts,
                    Eigen::Ref<Eigen::VectorXd> generalized);

// generalized (6+n,) += a force on the base whose line goes through the robot's center of mass,
// world axes [N].
void add_com_force(const RobotTerms& terms, const Eigen::Vector3d& force,
                   Eigen::Ref<Eigen::VectorXd> generalized);

// Column i of A (6, jets): rate of (l; w) per newton of jet i.
void jet_map(const RobotTerms& terms, Eigen::Ref<Matrix6Xd> A);

// Λ (6, 6+n): d(A T)/dt = Λ ν at constant thrusts T.
void jet_map_rate(const Model& model, const RobotTerms& terms,
                  const Eigen::Ref<const Eigen::VectorXd>& thrusts, Eigen::Ref<Matrix6Xd> Lambda);

}  // namespace codesign::dynamics
