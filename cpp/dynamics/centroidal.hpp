#pragma once

#include <Eigen/Core>

#include "dynamics/inertia.hpp"
#include "dynamics/kinematics.hpp"

// Quantities of the whole robot about its center of mass, world axes, linear part first.
// Nothing here allocates.
namespace codesign::dynamics {

// Center of mass in the world [m].
Eigen::Vector3d center_of_mass(const KinematicsData& kin, const InertiaData& inertia);

// (3, dofs): velocity of the center of mass per unit nu.
void center_of_mass_jacobian(const Model& model, const KinematicsData& kin,
                             const InertiaData& inertia,
                             Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>> J);

// Velocity of the center of mass [m/s].
Eigen::Vector3d center_of_mass_velocity(const Model& model, const KinematicsData& kin,
                                        const InertiaData& inertia, const VelocityData& velocity);

// C (6, dofs) with (l; w) = C nu: linear momentum, and angular momentum about the center of mass.
void centroidal_momentum_matrix(const Model& model, const KinematicsData& kin,
                                const InertiaData& inertia, Eigen::Ref<Matrix6Xd> C);

// (l; w) [kg m/s, kg m²/s], summed over the bodies.
Vector6d centroidal_momentum(const Model& model, const KinematicsData& kin,
                             const InertiaData& inertia, const VelocityData& velocity);

// Ċ nu: the rate of (l; w) for ν̇ = 0.
Vector6d centroidal_momentum_bias(const Model& model, const KinematicsData& kin,
                                  const InertiaData& inertia, const VelocityData& velocity);

// I_c: inertia of the robot frozen in its posture, about the center of mass [kg m²].
Eigen::Matrix3d locked_inertia(const InertiaData& inertia);

// Kinetic energy [J]; potential energy [J], zero when the center of mass is at world height 0.
double kinetic_energy(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                      const VelocityData& velocity);
double potential_energy(const KinematicsData& kin, const InertiaData& inertia);

}  // namespace codesign::dynamics
