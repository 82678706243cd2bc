#pragma once

#include <Eigen/Core>

#include "dynamics/flight_settings.hpp"
#include "dynamics/qp/box_qp.hpp"
#include "dynamics/reference.hpp"
#include "dynamics/robot_terms.hpp"

// Momentum control of a robot with jets: thrust rates and joint velocities that make linear and
// angular momentum follow their references, as one box-constrained QP per step. After Nava et al.,
// "Position and Attitude Control of an Underactuated Flying Humanoid Robot", Humanoids 2018.
//
// Unknowns u = (Ṫ, ṡ). The second derivative of the momentum is affine in them,
// (l̈; ẅ) = A Ṫ + Λ ν, so both can be asked for what a PD law with integral action wants. Linear,
// world axes, with the error e = m (v − v_ref), whose integral is m (x − x_ref):
//   ë + (1 + K_D) ė + (K_P + 1/K_I + K_D) e + K_P m (x − x_ref) = 0.
// Angular, base axes, with L = I₀ ω and the attitude error ε = skew(R_refᵀ R)∨, d: reference:
//   L̈ = L̈_d − ε̇ − (L̇ − L̇_d) − I₀⁻¹ (c₀ (L̇ − L̇_d) + c₀ ε + c₁ (L − L_d)).
// Both are E u + δ = 0. The constant-inertia task, rows E_I u + δ_I, asks the joints to move so
// that the angular momentum stays I₀ ω. Weights w, joint gains k, initial posture s₀:
//   min ½ w_m |E u + δ|² + ½ w_I |E_I u + δ_I|² + ½ w_p |ṡ + k (s − s₀)|² + ½ w_v |ṡ|²
//     + ½ w_T |Ṫ|² + ½ w_s Σ (Ṫ_a − Ṫ_b)² + ½ w_r |u|²   over symmetric pairs (a, b) of jets.
namespace codesign::dynamics {

// Rows of the task E u + δ = 0 (6) stacked on those of the constant-inertia task (3).
inline constexpr int kTaskRows = 9;

// What the controller froze at its first call.
struct ControllerOrigin {
  Eigen::Matrix3d base_inertia;          // I₀: locked inertia about the center of mass, base axes
  Eigen::Matrix3d base_inertia_inverse;  // I₀⁻¹
  Eigen::VectorXd posture;               // s₀ (joints)
};

// The origin at a state; posture as the settings give it, else that of the state.
ControllerOrigin controller_origin(const FlightSettings& settings, const RobotState& state,
                                   const RobotTerms& terms);

// E and δ above, then the constant-inertia rows: (9, jets + joints) and (9,).
struct MomentumTask {
  MomentumTask(int jets, int joints);
  Matrix6Xd A, Lambda;
  Eigen::Matrix<double, kTaskRows, Eigen::Dynamic> rows;
  Eigen::Matrix<double, kTaskRows, 1> offset;
};

// unmodeled: rate of momentum that acts beside thrusts and weight (MomentumObserver), world axes.
void build_momentum_task(const Model& model, const FlightSettings& settings,
                         const ControllerOrigin& origin, const RobotState& state,
                         const RobotTerms& terms, const Eigen::Ref<const Eigen::VectorXd>& thrusts,
                         const Reference& reference, const Vector6d& unmodeled, MomentumTask& task);

// A T − (m g e₃; 0), the modeled rate of momentum under thrusts T (jets,), world axes.
Vector6d modeled_momentum_rate(const RobotTerms& terms, const Eigen::Ref<const Matrix6Xd>& A,
                               const Eigen::Ref<const Eigen::VectorXd>& thrusts);

// min ½ uᵀHu + gᵀu, lower ≤ u ≤ upper. Symmetric pairs are tasks after those of MomentumTask.
struct MomentumQp {
  MomentumQp(const FlightSettings& settings, int joints);
  TaskObjective objective;
  Eigen::VectorXd lower, upper;
};

// Writes the QP above, with the bounds that joint ranges and thrust ranges leave to u.
void build_momentum_qp(const FlightSettings& settings, const ControllerOrigin& origin,
                       const MomentumTask& task, const RobotState& state,
                       const Eigen::Ref<const Eigen::VectorXd>& thrusts, MomentumQp& qp);

}  // namespace codesign::dynamics
