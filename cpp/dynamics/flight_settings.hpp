#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/actuator.hpp"

namespace codesign::dynamics {

// Everything that decides a flight besides the robot: plain data, nothing of any robot in here.
// SI units; vectors over joints have the order of FlightSettings::joints, vectors over jets that of
// FlightSettings::actuators. The default numbers are those of a humanoid with four jets of 250 N.

// A point of a body that is monitored for ground contact, for example a corner of a sole.
struct ContactPoint {
  std::string frame;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // in the frame [m]
};

// Pilot's command acting at samples with start < t < end (strict). The values are signs −1, 0, +1
// (or any factor) of the command speeds: forward along the base's x, to its left, up, roll,
// nose-down pitch, counter-clockwise yaw.
struct CommandWindow {
  double start = 0.0, end = 0.0;  // [s]
  double front = 0.0, left = 0.0, up = 0.0, roll = 0.0, pitch = 0.0, yaw = 0.0;
};

// Reference change per second of a command [m/s, rad/s].
struct CommandSpeeds {
  double front = 0.9375, left = 0.3125, up = 0.9375;
  double roll = 0.32724923474893679, pitch = 0.76358154774751929, yaw = 0.76358154774751929;
};

// From commands to smooth references.
struct ReferenceSettings {
  double roll_min = -0.087266462599716474, roll_max = 0.087266462599716474;  // [rad]
  double pitch_min = -0.52359877559829882, pitch_max = 0.0;                  // [rad]
  double com_time = 1.5;                // of the minimum-jerk filter of the CoM [s]
  double jerk_time = 0.005;             // of the filter that differentiates the acceleration [s]
  double rotation_gain = 1.0;           // of the first-order follower on SO(3) [1/s]
  double angular_velocity_time = 0.05;  // of the filter of its angular velocity [s]
};

struct Gains {
  double momentum_proportional = 1.5;               // K_P [1/s²]
  double momentum_derivative = 3.0618621784789726;  // K_D = 2.5 √K_P [1/s]
  double momentum_integral = 10.0;                  // K_O; its inverse enters
  double attitude_proportional = 50.0;              // c₀
  double attitude_derivative = 14.142135623730951;  // c₁ = 2 √c₀
  Eigen::VectorXd posture;                          // K_s (joints) [1/s]
  double torque_proportional = 14.142135623730951;  // k_P [1/s]
  double torque_integral = 50.0;                    // k_I [1/s²]
};

// Weights of the momentum QP and of the torque QP.
struct Weights {
  double momentum = 10.0;
  double constant_inertia = 150.0;
  double posture = 2.5;
  double joint_velocity = 10.0;
  double thrust_rate = 0.01;
  double thrust_symmetry = 0.1;
  double regularization = 1e-4;
  double torque = 1.1e-3;
};

struct Limits {
  Eigen::VectorXd joint_lower, joint_upper;  // (joints) [rad], before scaling
  Eigen::VectorXd joint_range_scale;         // (joints) factor on both
  double joint_speed = 0.78539816339744831;  // [rad/s]
  double joint_slope = 10.0;                 // of the tanh near the end of a range [1/rad]
  double thrust_slope = 2.0;                 // of the tanh near the end of the thrust range [1/N]
  double torque = 50.0;                      // [Nm]
  double torque_rate = 300.0;                // [Nm/s]
};

// Joints whose velocity error makes one term of the joint-velocity objective.
struct JointGroup {
  std::string name;
  std::vector<std::string> joints;
  double weight = 1.0;
};

// The flight is lost beyond these.
struct FailureLimits {
  double com_error = 2.0;                      // [m]
  double attitude_error = 1.5707963267948966;  // [rad]
  double joint_speed = 50.0;                   // [rad/s]
};

// How the plant is advanced over one control step under held inputs.
enum class Integrator {
  kEuler,              // explicit, all rates from the old state: the published one
  kSemiImplicitEuler,  // new velocity first, then the configuration with it
  kRungeKutta4,        // classical fourth order on the Lie group (Munthe-Kaas)
};

// What the controller does not know. Gusts are a first-order Gauss-Markov process per world axis;
// every random number comes from the seed through the generator of disturbance.hpp.
struct Disturbances {
  Eigen::Vector3d wind_force = Eigen::Vector3d::Zero();      // on the base's origin, world axes [N]
  Eigen::Vector3d gust_deviation = Eigen::Vector3d::Zero();  // standard deviation [N]
  double gust_time = 1.0;                                    // correlation time [s]
  double mass_scale = 1.0;        // plant's inertias over the model's, all bodies alike
  double mass_deviation = 0.0;    // relative standard deviation, drawn per body
  Eigen::VectorXd thrust_scale;   // plant's thrust over the jet's, per jet; empty: 1
  double thrust_deviation = 0.0;  // relative standard deviation, drawn per jet
  std::uint64_t seed = 0;
};

struct FlightSettings {
  double step = 0.008;     // of the control loop [s]
  double duration = 42.0;  // [s]; samples at 0, step, … up to and including the end
  Integrator integrator = Integrator::kEuler;
  int substeps = 1;  // plant steps per control step
  // Base rotations of a plant step below this angle are dropped [rad]. The published program drops
  // them below 1e-6, which shows in the sixth digit of its momentum errors. Not for Runge-Kutta.
  double rotation_deadband = 0.0;

  std::vector<std::string> joints;
  std::vector<Actuator> actuators;
  Eigen::Matrix4d base_pose = Eigen::Matrix4d::Identity();
  Eigen::VectorXd initial_joints;   // (joints) [rad]
  Eigen::VectorXd initial_thrusts;  // (jets) [N]
  bool initial_free_fall = true;    // first step without jets and torques, as published

  CommandSpeeds command_speeds;
  std::vector<CommandWindow> trajectory;
  ReferenceSettings reference;
  Gains gains;
  Weights weights;
  Limits limits;
  std::vector<std::pair<int, int>> symmetry_pairs;  // jets whose thrust rates should agree
  std::vector<JointGroup> groups;

  std::vector<ContactPoint> contact_points;
  double ground_height = 0.0;  // [m]
  FailureLimits failure;
  Disturbances disturbances;
};

// Throws std::invalid_argument naming the first attribute that has a wrong size, sign or value.
void validate(const FlightSettings& settings);

// Number of samples: the control step divides the duration up to rounding.
int sample_count(const FlightSettings& settings);

}  // namespace codesign::dynamics
