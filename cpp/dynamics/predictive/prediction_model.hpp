#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/flight_settings.hpp"
#include "dynamics/robot_terms.hpp"

// The robot as the predictive controller sees it: centroidal momentum in the axes of one link, the
// body, driven by thrusts and by displacements of joints that act at once. Linear, and constant
// over a prediction.
namespace codesign::dynamics {

using Matrix3Xd = Eigen::Matrix<double, 3, Eigen::Dynamic>;

// W(φ) with ω = W φ̇: ω the angular velocity in body axes, φ = (roll, pitch, yaw).
Eigen::Matrix3d rpy_rate_to_angular_velocity(const Eigen::Vector3d& rpy);

// What a prediction starts from.
struct PredictionState {
  explicit PredictionState(int jets = 0);
  Eigen::Vector3d com = Eigen::Vector3d::Zero();               // c, world axes [m]
  Eigen::Vector3d linear_momentum = Eigen::Vector3d::Zero();   // l, body axes [kg m/s]
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();               // φ of the body, unwrapped [rad]
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  // w about c, body axes [kg m²/s]
  Eigen::VectorXd thrust, thrust_rate;                         // (jets) [N], [N/s]
  Eigen::Vector3d com_integral = Eigen::Vector3d::Zero();
  Eigen::Vector3d rpy_integral = Eigen::Vector3d::Zero();
};

// T̈ = constant + per_thrust (T − thrust) + per_rate (Ṫ − thrust_rate) + per_variable (v − variable)
// about the state and throttle variable of the linearization. static_gain: dT/dv held steady.
struct JetPrediction {
  double constant = 0.0, per_thrust = 0.0, per_rate = 0.0, per_variable = 0.0, static_gain = 0.0;
  double thrust = 0.0, thrust_rate = 0.0, variable = 0.0;
};

// The jet about a state [N, N/s] and a throttle variable v.
JetPrediction linearize_jet(const StandardizedTurbine& turbine, const ThrustState& state, double v);

// ċ = world_R_body l / mass
// l̇ = force_of_thrust T − ω × l + force_of_joint Δs + weight + weight_per_rpy (φ − rpy)
// φ̇ = rpy_rate w
// ẇ = moment_of_thrust T − ω × w + moment_of_joint Δs
struct PredictionModel {
  PredictionModel(int joints, int jets);
  double mass = 1.0;                 // [kg]
  Eigen::Matrix3d world_R_body;      // R
  Eigen::Vector3d angular_velocity;  // ω, body axes [rad/s]
  Eigen::Matrix3d inertia;           // I of the robot about its center of mass, body axes
  Eigen::Matrix3d rpy_rate;          // W⁻¹ I⁻¹
  Eigen::Vector3d rpy;               // φ of the linearization
  Eigen::Vector3d weight;            // m Rᵀ g
  Eigen::Matrix3d weight_per_rpy;    // its derivative with respect to φ
  Matrix3Xd force_of_thrust;         // (3, jets)
  Matrix3Xd moment_of_thrust;        // (3, jets)
  Matrix3Xd force_of_joint;          // (3, joints that move) [N/rad]
  Matrix3Xd moment_of_joint;         // (3, joints that move) [N m/rad]
  std::vector<JetPrediction> jets;
};

// Builds prediction models of one robot. Allocates only in its constructor.
class PredictionModelBuilder {
 public:
  // Throws UnknownNameError for a link or joint that the model lacks; std::invalid_argument for a
  // joint that moves the body, and for an actuator whose dynamics are no StandardizedTurbine.
  PredictionModelBuilder(const Model& model, const FlightSettings& settings);

  int joint_count() const { return static_cast<int>(joints_.size()); }
  int jet_count() const { return static_cast<int>(turbines_.size()); }
  const std::vector<int>& joints() const { return joints_; }  // indices into Model::joints
  const std::vector<StandardizedTurbine>& turbines() const { return turbines_; }

  // Momenta and attitude of the body at a robot's state; integrals zero.
  void measure(const RobotTerms& terms, const std::vector<ThrustState>& jets,
               const Eigen::Vector3d& last_rpy, PredictionState& state) const;

  // About a measured state and the throttle variables (jets) that act.
  void build(const RobotTerms& terms, const PredictionState& state,
             const Eigen::VectorXd& variables, PredictionModel& prediction);

  Eigen::Matrix3d world_R_body(const RobotTerms& terms) const;
  // Roll, pitch and yaw of the body, each less than a half turn from `near` [rad].
  Eigen::Vector3d body_rpy(const RobotTerms& terms, const Eigen::Vector3d& near) const;

 private:
  Eigen::Vector3d angular_velocity(const RobotTerms& terms) const;  // of the body, world axes

  const Model& model_;
  PredictiveModelOptions options_;
  int body_ = 0;             // index of the frame
  std::vector<int> joints_;  // that the controller moves
  std::vector<StandardizedTurbine> turbines_;
  Matrix6Xd jet_map_, jet_map_rate_;
};

}  // namespace codesign::dynamics
