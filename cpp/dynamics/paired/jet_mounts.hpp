#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/actuator.hpp"
#include "dynamics/paired/paired_bodies.hpp"

namespace codesign::dynamics {

// An actuator on its body: where, along which axis and with which moment about it per thrust [m];
// body axes.
struct JetMount {
  int body = 0;
  Eigen::Vector3d origin, axis;
  double reaction = 0.0;
};

// The actuators on the bodies that hold their frames.
std::vector<JetMount> mount_jets(const Model& model, const std::vector<Actuator>& actuators);

// Pushes the bodies with thrusts (jets,) [N].
void push_jets(const std::vector<JetMount>& jets, const Eigen::Ref<const Eigen::VectorXd>& thrusts,
               PairedBodies& bodies);

}  // namespace codesign::dynamics
