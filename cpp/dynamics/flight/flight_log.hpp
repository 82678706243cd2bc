#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/flight/flight_measures.hpp"

namespace codesign::dynamics {

// A row per sample; row-major, so that a view from Python is C-contiguous.
using History = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using IntHistory = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Whether a flight reached its end.
enum class FlightStatus { kCompleted, kFailed };

// Why a flight was lost.
enum class FailureReason {
  kNotFailed,
  kNoHover,        // no trimmed state to start from
  kNoFuel,         // the tank is empty
  kMomentumQp,     // the momentum QP was not solved
  kTorqueQp,       // the torque QP was not solved
  kSingularMass,   // the mass matrix is singular
  kNotFinite,      // a value is not finite
  kComError,       // the center of mass is too far from its reference
  kAttitudeError,  // the base is turned too far from its reference
  kJointSpeed,     // a joint is too fast
};

// One family of objectives; all are to be minimized.
struct FlightObjectives {
  double momentum = 0.0;
  double joint_velocity = 0.0;
  double thrust = 0.0;  // mean total thrust [N]
};

// The terms of a family before they are added: of the linear momentum error E_l, of the angular
// momentum error E_w, and of the joint-velocity error of each group, without its weight.
struct ObjectiveParts {
  double linear_momentum = 0.0;
  double angular_momentum = 0.0;
  std::vector<double> joint_velocity;
};

// Wall time of a flight by phase of the step [s].
struct FlightProfile {
  double plant = 0.0;        // integration, jets
  double terms = 0.0;        // kinematics, inertias, mass matrix and its factorization, Jacobians
  double task = 0.0;         // references, building of the momentum QP
  double momentum_qp = 0.0;  // its solution
  double torque = 0.0;       // torque QP and rate limiter
  double log = 0.0;          // checks and histories
};

// Samples k = 0 … samples−1 at time k·step: the state at the sample, the thrust acting from then
// on, references and commands of the same sample. SI units, world axes unless stated.
struct FlightLog {
  int samples = 0;
  double step = 0.0;
  FlightStatus status = FlightStatus::kCompleted;
  FailureReason failure_reason = FailureReason::kNotFailed;
  double failure_time = 0.0;  // [s]; meaningful for a failed flight
  bool ground_touched = false;

  History time;                        // (N, 1)
  History base_position;               // (N, 3)
  History base_rotation;               // (N, 9) world_R_base, row after row
  History joint_positions;             // (N, joints)
  History velocity;                    // (N, 6 + joints) mixed
  History com, com_reference;          // (N, 3)
  History com_velocity_reference;      // (N, 3)
  History rotation_reference;          // (N, 9)
  History angular_velocity_reference;  // (N, 3) base axes
  History momentum;                    // (N, 6) linear, angular about the center of mass
  History momentum_error;              // (N, 6) E_l, E_w
  History unmodeled_force;             // (N, 6) the observer's force and moment about the CoM
  History thrust;                      // (N, jets)
  History thrust_rate_command;         // (N, jets)
  History thrust_command;              // (N, jets) unit as the dynamics: [N/s], [N] or [%]
  History joint_velocity_command;      // (N, joints)
  History torque;                      // (N, joints)
  History wind;                        // (N, 3) force on the base's origin
  History clearance;                   // (N, 1) lowest contact point above the ground
  IntHistory qp_iterations;            // (N, 2) linear systems of the momentum and the torque QP
  IntHistory active_bounds;            // (N, 1) of the momentum QP

  // Summary over the logged samples.
  double max_com_error = 0.0, max_attitude_error = 0.0;  // [m], [rad]
  double min_thrust = 0.0, max_thrust = 0.0;             // [N]
  double max_torque = 0.0, max_joint_speed = 0.0;        // [Nm], [rad/s]
  double min_clearance = 0.0;                            // [m]
  double fuel_burnt = 0.0;                               // [kg]
  int qp_failures = 0;
  long total_qp_iterations = 0;
  FlightProfile profile;

  FlightMeasures measures;

  // Objective families (docs/flight.md): rms (SI, independent of the step), script (as the authors'
  // program computes it), paper (as printed).
  FlightObjectives rms, script, paper;
  ObjectiveParts rms_parts, script_parts;
};

// Room for `samples` rows.
FlightLog make_flight_log(int samples, int joints, int jets);

// Drops the rows after the last logged sample.
void truncate(FlightLog& log);

}  // namespace codesign::dynamics
