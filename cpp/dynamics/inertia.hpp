#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/kinematics.hpp"

// Inertias in world axes: of each moving body, and of each subtree of
// bodies (composite rigid bodies).
namespace codesign::dynamics {

// Room for the inertias of one model's bodies.
struct InertiaData {
  explicit InertiaData(const Model& model);
  std::vector<RigidInertia> bodies;    // world axes, center of mass from the base origin
  std::vector<RigidInertia> subtrees;  // the same for the body and all its descendants, locked
};

// Writes inertia; needs the kinematics only.
void compute_inertias(const Model& model, const KinematicsData& kin, InertiaData& inertia);

// Linear momentum of the body's subtree, and its angular momentum about the subtree's own center of
// mass, for unit velocity of the body's joint; world axes.
struct JointMomentum {
  Eigen::Vector3d linear, angular;
};
JointMomentum joint_momentum(const Body& body, const BodyPose& pose, const RigidInertia& subtree);

}  // namespace codesign::dynamics
