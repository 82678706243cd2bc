#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/inertia.hpp"
#include "dynamics/kinematics.hpp"

// Equations of motion  M(q) ν̇ + b(q, ν) = (0; tau) + Σ Jᵀ w,  mixed convention (model.hpp).
// Nothing here allocates, apart from the constructors of the scratch structs.
namespace codesign::dynamics {

// Scratch of the Newton-Euler recursions, per body, at the body origin, world axes.
struct ForceData {
  explicit ForceData(const Model& model);
  struct Acceleration {
    Eigen::Vector3d linear, angular;  // the part linear in ν̇ [m/s²], [rad/s²]
  };
  struct Wrench {
    Eigen::Vector3d force, moment;  // on the body with its subtree [N], [N m]
  };
  std::vector<Acceleration> accelerations;
  std::vector<Wrench> bodies;
};

// M (dofs, dofs), symmetric, both triangles written. Composite rigid bodies (Featherstone, "Rigid
// Body Dynamics Algorithms", ch. 6), about each subtree's center of mass.
void mass_matrix(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                 Eigen::Ref<Eigen::MatrixXd> M);

// Force and moment [N, N m] at the body origin that ν̇ = 0 takes, gravity included.
ForceData::Wrench bias_wrench(const BodyPose& pose, const RigidInertia& body,
                              const BodyVelocity& velocity);

// b (dofs,): gravity, Coriolis and centrifugal forces. Newton-Euler recursion.
void bias_forces(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                 const VelocityData& velocity, ForceData& scratch, Eigen::Ref<Eigen::VectorXd> b);

// g (dofs,): b at rest.
void gravity_forces(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                    Eigen::Ref<Eigen::VectorXd> g);

// M ν̇ + b (dofs,): the generalized forces that cause nu_dot. Recursive Newton-Euler (same book, ch.
// 5).
void inverse_dynamics(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                      const VelocityData& velocity, const Eigen::Ref<const Eigen::VectorXd>& nu_dot,
                      ForceData& scratch, Eigen::Ref<Eigen::VectorXd> generalized_forces);

}  // namespace codesign::dynamics
