#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "base/random_stream.hpp"
#include "dynamics/flight_settings.hpp"
#include "dynamics/model.hpp"

// What the plant has and the controller does not know: wind, gusts, errors of mass and thrust.
namespace codesign::dynamics {

// A Gauss-Markov process of first order per world axis, x ← φ x + √(1−φ²) ξ, φ = exp(−Δ/time),
// started in its stationary distribution and linear between its nodes. The nodes are Δ = time/20
// apart (at least 1 ms) from the start of the flight on, whatever the steps of loop and plant, so
// that a flight meets the same wind at any of its steps. √(3/(2+φ)) makes up for what the lines
// between the nodes take from the variance. The power density is that of the process, 2 σ² time/(1
// + (2π f time)²), below 1/(2 Δ).
class Gusts {
 public:
  explicit Gusts(const FlightSettings& settings);

  // Force on the base's origin, mean wind included [N]. Times [s] must not decrease from call to
  // call.
  Eigen::Vector3d at(double time);

 private:
  Eigen::Vector3d draw();

  Eigen::Vector3d mean_, deviation_;
  double interval_, memory_, drive_;
  bool calm_;
  RandomStream random_;
  std::int64_t node_ = 0;
  Eigen::Vector3d last_, next_;  // at the nodes around the time, in deviations
};

// Plant's mass over the model's, per body of the model, in the model's order.
Eigen::VectorXd body_mass_scales(const Disturbances& disturbances, int bodies);

// Plant's thrust over the jet's, per jet.
Eigen::VectorXd thrust_scales(const Disturbances& disturbances, int jets);

// The model with every body's mass and inertia multiplied by its scale.
Model scale_masses(const Model& model, const Eigen::VectorXd& scales);

}  // namespace codesign::dynamics
