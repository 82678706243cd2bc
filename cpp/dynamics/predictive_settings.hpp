#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

// Multi-rate model-predictive control of centroidal momentum, after Gorbani et al., "Multi-rate
// momentum MPC for a jet-powered humanoid", Humanoids 2025, and their published program: plain
// data.
namespace codesign::dynamics {

// Diagonal weights; vectors are x, y, z or roll, pitch, yaw.
struct PredictiveWeights {
  Eigen::Vector3d com{500.0, 500.0, 5000.0};
  Eigen::Vector3d com_integral{25000.0, 25000.0, 50000.0};
  Eigen::Vector3d linear_momentum{1.0, 1.0, 1.5};  // axes of the body
  Eigen::Vector3d attitude{1000.0, 1000.0, 1000.0};
  Eigen::Vector3d attitude_integral{10000.0, 10000.0, 10000.0};
  Eigen::Vector3d angular_momentum{80.0, 80.0, 80.0};  // axes of the body
  double joint_displacement = 65000.0;                 // [1/rad²]
  double posture = 20.0;                               // [1/rad²]
  double throttle_first = 80000.0;   // of the first block from the throttle that acts
  double throttle_change = 80000.0;  // between blocks
};

// Where the integrals of position and attitude error start in every solve.
enum class PredictiveIntegral {
  kRestart,     // at the present error, as published: a strong proportional term
  kAccumulate,  // at the sum of all errors so far
};

// What of the prediction is left out; all true is the controller.
struct PredictiveModelOptions {
  bool gravity_coupling = true;  // gravity turns with the predicted attitude; published: false
  bool jet_dynamics = true;      // false: thrust follows the throttle at once
  bool varying = true;           // false: the linearization of the first solve is kept
};

// Multi-rate predictive control: joints every period, throttles every few.
struct PredictiveSettings {
  double period = 0.005;            // of solves and joint set points [s]
  int throttle_every = 20;          // solves
  int small_steps = 7;              // adding up to large_step
  int large_steps = 10;             //
  double large_step = 0.1;          // [s]
  int control_steps = 12;           // steps with a joint block of their own
  std::string body;                 // the link whose attitude is controlled
  std::vector<std::string> joints;  // that the controller moves; their servos hold the others
  double joint_speed = 2.0;         // largest [rad/s]; infinity: no bound
  PredictiveIntegral integral = PredictiveIntegral::kRestart;
  PredictiveModelOptions model;
  PredictiveWeights weights;
};

// Position servos: τ = k_p (s* − s) − k_d ṡ, k_d = passive + 2 ratio √(k_p M_jj) with M_jj the
// joint's entry of the mass matrix at the start.
struct ServoSettings {
  Eigen::VectorXd stiffness;      // k_p (joints) [N m/rad]
  Eigen::VectorXd damping_ratio;  // (joints)
  Eigen::VectorXd passive;        // (joints) [N m s/rad]
};

// How the robot with its servos is advanced between solves.
enum class ServoIntegrator {
  kImplicit,     // servos implicit, everything else explicit: one mass matrix a step
  kRungeKutta4,  // classical fourth order, robot and jets together
};

// A robot with position servos, and how it is advanced.
struct ServoPlantSettings {
  ServoSettings servo;
  ServoIntegrator integrator = ServoIntegrator::kImplicit;
  double step = 0.001;  // at most; a period is cut into equal steps [s]
};

// A force on the base with its line through the center of mass, and a moment on the base, world
// axes, for a time.
struct Pulse {
  double start = 0.0, duration = 0.0;                // [s]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // [N m]
};

// Throws std::invalid_argument naming what is wrong.
void validate(const PredictiveSettings& settings);
void validate(const ServoPlantSettings& settings, Eigen::Index joints);
void validate(const std::vector<Pulse>& pulses);

}  // namespace codesign::dynamics
