#pragma once

#include <Eigen/Core>

#include "base/random_stream.hpp"
#include "dynamics/flight_settings.hpp"
#include "dynamics/model.hpp"

// What the plant has and the controller does not know: wind, gusts, errors of mass and thrust.
namespace codesign::dynamics {

// First-order Gauss-Markov force per world axis: x ← φ x + σ √(1−φ²) ξ, φ = exp(−step/time),
// started in its stationary distribution.
class Gusts {
 public:
  explicit Gusts(const FlightSettings& settings);
  Eigen::Vector3d next();  // force on the base's origin, mean wind included [N]

 private:
  Eigen::Vector3d mean_, deviation_, state_;
  double memory_, drive_;
  bool calm_;
  RandomStream random_;
};

// Plant's mass over the model's, per body of the model, in the model's order.
Eigen::VectorXd body_mass_scales(const Disturbances& disturbances, int bodies);

// Plant's thrust over the jet's, per jet.
Eigen::VectorXd thrust_scales(const Disturbances& disturbances, int jets);

// The model with every body's mass and inertia multiplied by its scale.
Model scale_masses(const Model& model, const Eigen::VectorXd& scales);

}  // namespace codesign::dynamics
