#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/flight_settings.hpp"
#include "dynamics/paired/paired_bodies.hpp"
#include "dynamics/robot_terms.hpp"

namespace codesign::dynamics {

// Aerodynamic drag of the robot's parts in steady wind, quadratic in the velocity against the air.
class Drag {
 public:
  Drag(const Model& model, const FlightSettings& settings);

  // generalized (6+n,) += Σ Jᵀ force at the state of the terms (kinematics and velocities).
  void add_forces(const Model& model, const RobotTerms& terms,
                  Eigen::Ref<Eigen::VectorXd> generalized) const;

  // Pushes the bodies at the state they were moved to.
  void push(PairedBodies& bodies) const;

 private:
  struct Area {
    int body;
    Eigen::Vector3d position;  // body axes [m]
    double factor;             // ½ ρ C_d A [kg/m]
  };
  Eigen::Vector3d force(const Area& area, const Eigen::Vector3d& velocity) const;

  std::vector<Area> areas_;
  Eigen::Vector3d wind_;
};

}  // namespace codesign::dynamics
