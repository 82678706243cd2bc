#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/actuator.hpp"
#include "dynamics/predictive_settings.hpp"
#include "dynamics/trim.hpp"
#include "dynamics/waypoints.hpp"

namespace codesign::dynamics {

// Everything that decides a flight besides the robot: plain data, nothing of any robot in here.
// SI units; vectors over joints have the order of FlightSettings::joints, vectors over jets that of
// FlightSettings::actuators. What is zero by default and has to be positive must be given.

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
  double front = 0.0, left = 0.0, up = 0.0, roll = 0.0, pitch = 0.0, yaw = 0.0;
};

// From commands to smooth references.
struct ReferenceSettings {
  double roll_min = 0.0, roll_max = 0.0;    // [rad]
  double pitch_min = 0.0, pitch_max = 0.0;  // [rad]
  double com_time = 0.0;                    // of the minimum-jerk filter of the CoM [s]
  double jerk_time = 0.0;              // of the filter that differentiates the acceleration [s]
  double rotation_gain = 0.0;          // of the first-order follower on SO(3) [1/s]
  double angular_velocity_time = 0.0;  // of the filter of its angular velocity [s]
};

// Gains of the momentum, attitude, posture and torque loops.
struct Gains {
  double momentum_proportional = 0.0;  // K_P [1/s²]
  double momentum_derivative = 0.0;    // K_D [1/s]
  double momentum_integral = 0.0;      // K_O; its inverse enters
  double attitude_proportional = 0.0;  // c₀
  double attitude_derivative = 0.0;    // c₁
  Eigen::VectorXd posture;             // K_s (joints) [1/s]
  double torque_proportional = 0.0;    // k_P [1/s]
  double torque_integral = 0.0;        // k_I [1/s²]
  double observer = 0.0;               // of the momentum observer [1/s]; 0: none
};

// Weights of the momentum QP and of the torque QP.
struct Weights {
  double momentum = 0.0;          // of the momentum's error
  double constant_inertia = 0.0;  // of the task that keeps the inertia constant
  double posture = 0.0;           // of the distance from the initial posture
  double joint_velocity = 0.0;    // of joint velocities
  double thrust_rate = 0.0;       // of thrust rates
  double thrust_symmetry = 0.0;   // of differences within symmetry_pairs
  double regularization = 0.0;    // of everything, so that the solution is unique
  double torque = 0.0;            // of torques, in the torque QP
};

// Ranges and steepnesses of the limits that the controllers keep.
struct Limits {
  Eigen::VectorXd joint_lower, joint_upper;  // (joints) [rad], before scaling; empty: the model's
  Eigen::VectorXd joint_range_scale;         // (joints) factor on both
  double joint_speed = 0.0;                  // [rad/s]
  double joint_slope = 0.0;                  // of the tanh near the end of a range [1/rad]
  double thrust_slope = 0.0;                 // of the tanh near the end of the thrust range [1/N]
  double torque = 0.0;                       // [Nm]
  double torque_rate = 0.0;                  // [Nm/s]
};

// Joints whose velocity error makes one term of the joint-velocity objective.
struct JointGroup {
  std::string name;
  std::vector<std::string> joints;
  double weight = 1.0;
};

// The flight is lost beyond these.
struct FailureLimits {
  double com_error = 0.0;       // [m]
  double attitude_error = 0.0;  // [rad]
  double joint_speed = 0.0;     // [rad/s]
};

// How the plant is advanced over one control step under held inputs.
enum class Integrator {
  kEuler,              // explicit, all rates from the old state: the published one
  kSemiImplicitEuler,  // new velocity first, then the configuration with it
  kRungeKutta4,        // classical fourth order on the Lie group (Munthe-Kaas)
};

// Friction of the joints' drives, in the plant only: viscous ṡ + coulomb tanh(ṡ / slip_speed).
struct Friction {
  Eigen::VectorXd viscous;   // (joints) [N m s/rad]; empty: none
  Eigen::VectorXd coulomb;   // (joints) [N m]; empty: none
  double slip_speed = 0.02;  // below it the second term is as good as viscous [rad/s]
};

// How late the robot gets what the controllers ask for.
struct Delays {
  double momentum = 0.0;    // thrust rates and joint velocities; whole steps of the loop [s]
  double torque = 0.0;      // whole periods of the torque loop [s]
  double torque_lag = 0.0;  // time constant of the drives [s]; 0: none
};

// A part of the robot that air drags: force −½ ρ area |u| u at the point, u the velocity against
// the air.
struct DragArea {
  std::string frame;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // in the frame [m]
  double area = 0.0;                                   // C_d A [m²]
};

// Fuel on board, part of its link's inertia at the start; the controller does not see it go.
struct Tank {
  std::string frame;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // of the fuel, in the frame [m]
  double fuel = 0.0;                                   // [kg]
  double consumption = 0.0;                            // [kg/(N s)] of the actuators' thrust
};

// What the controller does not know. Gusts are a first-order Gauss-Markov process per world axis
// that depends on no step; every random number comes from the seed (disturbance.hpp).
struct Disturbances {
  Eigen::Vector3d wind_force = Eigen::Vector3d::Zero();      // on the base's origin, world axes [N]
  Eigen::Vector3d wind_velocity = Eigen::Vector3d::Zero();   // of the air, world axes [m/s]
  Eigen::Vector3d gust_deviation = Eigen::Vector3d::Zero();  // standard deviation [N]
  double gust_time = 1.0;                                    // correlation time [s]
  double mass_scale = 1.0;        // plant's inertias over the model's, all bodies alike
  double mass_deviation = 0.0;    // relative standard deviation, drawn per body
  Eigen::VectorXd thrust_scale;   // plant's thrust over the jet's, per jet; empty: 1
  double thrust_deviation = 0.0;  // relative standard deviation, drawn per jet
  std::uint64_t seed = 0;
};

// What flies the robot.
enum class Controller {
  kMomentumQp,  // momentum and torque QPs, torque-driven joints
  kPredictive,  // multi-rate predictive control, joints with position servos
};

// Everything that decides a flight besides the robot.
struct FlightSettings {
  Controller controller = Controller::kMomentumQp;
  double step = 0.0;       // of the momentum loop, jets and samples [s]
  double duration = 0.0;   // [s]; samples at 0, step, … up to and including the end
  int torque_updates = 1;  // of the torque loop per step, evenly spaced
  // Torque updates between two momentum QPs take the joint-space inertia of the last momentum QP;
  // all forces are those of the time.
  bool hold_inertia = false;
  Integrator integrator = Integrator::kEuler;
  int substeps = 1;  // plant steps per torque update
  // Base rotations of a plant step below this angle are dropped [rad]. The published program drops
  // them below 1e-6, which shows in the sixth digit of its momentum errors. Not for Runge-Kutta.
  double rotation_deadband = 0.0;

  std::vector<std::string> joints;
  std::vector<Actuator> actuators;
  Eigen::Matrix4d base_pose = Eigen::Matrix4d::Identity();
  Eigen::VectorXd initial_joints;   // (joints) [rad]
  Eigen::VectorXd initial_thrusts;  // (jets) [N]
  bool initial_free_fall = false;   // first step without jets and torques, as published
  // Start in the hover nearest to the state above instead of in it; ranges are those of the limits.
  std::optional<TrimSettings> trim;
  Eigen::VectorXd posture_reference;  // (joints) [rad]; empty: the angles at the start

  // Of each drive, as its joint feels it (gear ratio² times the rotor's) [kg m²]; plant and
  // controller know it. Empty: none.
  Eigen::VectorXd rotor_inertia;
  Friction friction;
  Delays delays;
  std::vector<DragArea> drag;
  double air_density = 1.225;  // [kg/m³]
  std::optional<Tank> tank;

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
  WaypointPath path;  // replaces the commands if it has way-points
  std::vector<Pulse> pulses;
  FuelRate fuel;  // of each jet

  PredictiveSettings predictive;  // of Controller::kPredictive; period is `step`
  ServoPlantSettings servo_plant;
};

// Throws std::invalid_argument naming the first attribute that has a wrong size, sign or value.
void validate(const FlightSettings& settings);

// Number of samples: the control step divides the duration up to rounding.
int sample_count(const FlightSettings& settings);

}  // namespace codesign::dynamics
