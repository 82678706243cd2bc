#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <span>
#include <vector>

#include "dynamics/rigid_body.hpp"

namespace codesign::dynamics {

// External force and moment on a frame, at the frame's origin, world axes [N], [N m].
struct FrameWrench {
  int frame = 0;
  Vector6d wrench;  // force, moment
};

// Scratch: articulated inertia of each body at its origin, world axes, as the map
// (force; moment) = [linear coupling; couplingᵀ angular] (linear; angular acceleration) + bias.
struct ArticulatedData {
  explicit ArticulatedData(const Model& model);
  struct Body {
    Eigen::Matrix3d linear, coupling, angular;
    Eigen::Vector3d force, moment;              // bias
    Eigen::Vector3d joint_force, joint_moment;  // inertia times joint axis
    double joint_inertia;                       // seen by the joint
    double joint_force_left;                    // joint force less bias
    Eigen::Vector3d linear_acceleration, angular_acceleration;
  };
  std::vector<Body> bodies;
  // Of models with bodies that share a joint, which are no tree of coordinates.
  ForceData forces;
  Eigen::MatrixXd mass;
  Matrix6Xd jacobian;
  Eigen::PartialPivLU<Eigen::MatrixXd> factor;
};

// ν̇ (dofs,) of M ν̇ + b = (0; tau) + Σ Jᵀ wrench. tau: (n,) joint forces [N m] or [N].
// Articulated bodies (Featherstone, ch. 7) without square roots, so that the indefinite mass
// matrices of the published robots are accepted. Where bodies share a joint, the mass matrix is
// factored instead. At an exactly singular mass matrix the result is
// not finite.
void forward_dynamics(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                      const VelocityData& velocity, const Eigen::Ref<const Eigen::VectorXd>& tau,
                      std::span<const FrameWrench> wrenches, ArticulatedData& scratch,
                      Eigen::Ref<Eigen::VectorXd> nu_dot);

}  // namespace codesign::dynamics
