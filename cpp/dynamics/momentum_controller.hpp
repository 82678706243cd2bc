#pragma once

#include <Eigen/Core>

#include "dynamics/box_qp.hpp"
#include "dynamics/flight_settings.hpp"
#include "dynamics/reference.hpp"
#include "dynamics/robot_terms.hpp"

// Momentum control of a robot with jets: thrust rates and joint velocities that make linear and
// angular momentum follow their references, as one box-constrained QP a step. After Nava et al.,
// "Position and Attitude Control of an Underactuated Flying Humanoid Robot", Humanoids 2018.
//
// Unknowns u = (Ṫ, ṡ). The second derivative of the momentum is affine in them,
// (l̈; ẅ) = A Ṫ + Λ ν, so both can be asked for what a PD law with integral action wants.
namespace codesign::dynamics {

// Rows of the task E u + δ = 0 (6) stacked on those of the constant-inertia task (3).
inline constexpr int kTaskRows = 9;

// What the controller froze at its first call.
struct ControllerOrigin {
  Eigen::Matrix3d base_inertia;          // I₀: locked inertia about the centre of mass, base axes
  Eigen::Matrix3d base_inertia_inverse;  // I₀⁻¹
  Eigen::VectorXd posture;               // s₀ (joints)
};

ControllerOrigin controller_origin(const RobotState& state, const RobotTerms& terms);

// E and δ above, then the constant-inertia rows: task is (jets + joints, 9), transposed so that its
// columns are contiguous; offset is (9,).
struct MomentumTask {
  MomentumTask(int jets, int joints);
  Matrix6Xd A, Lambda;
  Eigen::Matrix<double, Eigen::Dynamic, kTaskRows> rows;
  Eigen::Matrix<double, kTaskRows, 1> offset;
};

void build_momentum_task(const Model& model, const FlightSettings& settings,
                         const ControllerOrigin& origin, const RobotState& state,
                         const RobotTerms& terms, const Eigen::Ref<const Eigen::VectorXd>& thrusts,
                         const Reference& reference, MomentumTask& task);

// min ½ uᵀHu + gᵀu, lower ≤ u ≤ upper.
struct MomentumQp {
  explicit MomentumQp(int size);
  Eigen::MatrixXd H;
  Eigen::VectorXd g, lower, upper;
};

void build_momentum_qp(const FlightSettings& settings, const ControllerOrigin& origin,
                       const MomentumTask& task, const RobotState& state,
                       const Eigen::Ref<const Eigen::VectorXd>& thrusts, MomentumQp& qp);

}  // namespace codesign::dynamics
