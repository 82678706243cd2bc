#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/inertia.hpp"
#include "dynamics/kinematics.hpp"

// Equations of motion  M(q) ν̇ + b(q, ν) = (0; tau) + Σ Jᵀ w,  mixed convention (model.hpp).
// Nothing here allocates, apart from the constructors of the scratch structs.
namespace codesign::dynamics {

// Forces on each body and its descendants, at the body origin, world axes.
struct ForceData {
  explicit ForceData(const Model& model);
  struct Wrench {
    Eigen::Vector3d force, moment;
  };
  std::vector<Wrench> bodies;
};

// M (dofs, dofs), symmetric, both triangles written. Composite rigid bodies (Featherstone, "Rigid
// Body Dynamics Algorithms", ch. 6), about each subtree's centre of mass.
void mass_matrix(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                 Eigen::Ref<Eigen::MatrixXd> M);

// b (dofs,): gravity, Coriolis and centrifugal forces. Newton-Euler recursion.
void bias_forces(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                 const VelocityData& velocity, ForceData& scratch, Eigen::Ref<Eigen::VectorXd> b);

// g (dofs,): b at rest.
void gravity_forces(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                    Eigen::Ref<Eigen::VectorXd> g);

}  // namespace codesign::dynamics
