#include "dynamics/forward_dynamics.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cassert>
#include <cmath>
#include <limits>

namespace codesign::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

ArticulatedData::ArticulatedData(const Model& model)
    : bodies(model.bodies.size()),
      forces(model),
      mass(model.mimics ? model.dofs() : 0, model.mimics ? model.dofs() : 0),
      jacobian(6, model.mimics ? model.dofs() : 0),
      factor(mass.rows()) {}

namespace {

// Each body alone: its own inertia and the wrench that ν̇ = 0 takes.
void start_bodies(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                  const VelocityData& velocity, ArticulatedData& articulated) {
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const RigidInertia& own = inertia.bodies[i];
    ArticulatedData::Body& body = articulated.bodies[i];
    const Vector3d arm = own.com - kin.bodies[i].p;
    body.linear = Vector3d::Constant(own.mass).asDiagonal();
    body.coupling = -skew(own.mass * arm);
    body.angular = own.inertia + point_inertia(own.mass, arm);
    const ForceData::Wrench bias = bias_wrench(kin.bodies[i], own, velocity.bodies[i]);
    body.force = bias.force;
    body.moment = bias.moment;
  }
}

// S(d) m, column by column.
Matrix3d cross_columns(const Vector3d& d, const Matrix3d& m) {
  Matrix3d result;
  for (int i = 0; i < 3; ++i) result.col(i) = d.cross(m.col(i));
  return result;
}

constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();

// What a joint moves, or exactly zero where that is no more than rounding of the whole: a singular
// mass matrix then gives no numbers instead of huge ones.
double unless_rounding(double moved, double whole) {
  return std::abs(moved) > kRounding * whole ? moved : 0.0;
}

// Removes the motion that the joint leaves free, and hands the rest to the parent.
void hand_down(const ArticulatedData::Body& body, const Vector3d& offset,
               ArticulatedData::Body& parent) {
  const double scale = 1.0 / body.joint_inertia;
  const Vector3d scaled_force = scale * body.joint_force;
  const Vector3d scaled_moment = scale * body.joint_moment;
  const Matrix3d linear = body.linear - scaled_force * body.joint_force.transpose();
  const Matrix3d coupling = body.coupling - scaled_force * body.joint_moment.transpose();
  const Matrix3d angular = body.angular - scaled_moment * body.joint_moment.transpose();
  // With the reference point moved by -d: H' = H - M S(d),  I' = I + S(d) H' + (S(d) H)ᵀ.
  const Matrix3d moved_coupling = coupling + cross_columns(offset, linear).transpose();
  parent.linear += linear;
  parent.coupling += moved_coupling;
  parent.angular +=
      angular + cross_columns(offset, moved_coupling) + cross_columns(offset, coupling).transpose();
  const Vector3d force = body.force + body.joint_force_left * scaled_force;
  parent.force += force;
  parent.moment += body.moment + body.joint_force_left * scaled_moment + offset.cross(force);
}

void accelerate_base(const Model& model, ArticulatedData::Body& base) {
  if (model.fixed_base) {
    base.linear_acceleration.setZero();
    base.angular_acceleration.setZero();
    return;
  }
  Matrix6d A;
  A << base.linear, base.coupling, base.coupling.transpose(), base.angular;
  Vector6d bias;
  bias << base.force, base.moment;
  const Vector6d acceleration = A.partialPivLu().solve(-bias);
  base.linear_acceleration = acceleration.head<3>();
  base.angular_acceleration = acceleration.tail<3>();
}

// nu_dot = M⁻¹ ((0; tau) + Σ Jᵀ wrench − b).
void accelerate_by_mass_matrix(const Model& model, const KinematicsData& kin,
                               const InertiaData& inertia, const VelocityData& velocity,
                               const Eigen::Ref<const Eigen::VectorXd>& tau,
                               std::span<const FrameWrench> wrenches, ArticulatedData& scratch,
                               Eigen::Ref<Eigen::VectorXd> nu_dot) {
  mass_matrix(model, kin, inertia, scratch.mass);
  bias_forces(model, kin, inertia, velocity, scratch.forces, nu_dot);
  nu_dot = -nu_dot;
  nu_dot.tail(model.joint_count()) += tau;
  for (const FrameWrench& external : wrenches) {
    frame_jacobian(model, kin, external.frame, scratch.jacobian);
    nu_dot.noalias() += scratch.jacobian.transpose() * external.wrench;
  }
  scratch.factor.compute(scratch.mass);
  nu_dot = scratch.factor.solve(nu_dot).eval();
}

}  // namespace

void forward_dynamics(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                      const VelocityData& velocity, const Eigen::Ref<const Eigen::VectorXd>& tau,
                      std::span<const FrameWrench> wrenches, ArticulatedData& scratch,
                      Eigen::Ref<Eigen::VectorXd> nu_dot) {
  assert(tau.size() == model.joint_count() && nu_dot.size() == model.dofs());
  if (model.mimics) {
    accelerate_by_mass_matrix(model, kin, inertia, velocity, tau, wrenches, scratch, nu_dot);
    return;
  }
  start_bodies(model, kin, inertia, velocity, scratch);
  for (const FrameWrench& external : wrenches) {
    const Frame& frame = model.frames[static_cast<std::size_t>(external.frame)];
    const auto index = static_cast<std::size_t>(frame.body);
    const Vector3d arm = kin.bodies[index].R * frame.body_T_frame.p;
    const Vector3d force = external.wrench.head<3>();
    scratch.bodies[index].force -= force;
    scratch.bodies[index].moment -= external.wrench.tail<3>() + arm.cross(force);
  }
  for (std::size_t i = model.bodies.size() - 1; i > 0; --i) {
    const Body& body = model.bodies[i];
    const Vector3d axis = kin.bodies[i].axis();
    ArticulatedData::Body& a = scratch.bodies[i];
    if (body.type == JointType::kRevolute) {
      a.joint_force.noalias() = a.coupling * axis;
      a.joint_moment.noalias() = a.angular * axis;
      a.joint_inertia = unless_rounding(axis.dot(a.joint_moment), a.angular.norm());
      a.joint_force_left = tau[body.joint] - axis.dot(a.moment);
    } else {
      a.joint_force.noalias() = a.linear * axis;
      a.joint_moment.noalias() = a.coupling.transpose() * axis;
      a.joint_inertia = unless_rounding(axis.dot(a.joint_force), a.linear.norm());
      a.joint_force_left = tau[body.joint] - axis.dot(a.force);
    }
    hand_down(a, kin.bodies[i].offset, scratch.bodies[static_cast<std::size_t>(body.parent)]);
  }
  accelerate_base(model, scratch.bodies[0]);
  if (!model.fixed_base) {
    nu_dot.head<3>() = scratch.bodies[0].linear_acceleration;
    nu_dot.segment<3>(3) = scratch.bodies[0].angular_acceleration;
  }
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    const Body& body = model.bodies[i];
    const BodyPose& pose = kin.bodies[i];
    const ArticulatedData::Body& parent = scratch.bodies[static_cast<std::size_t>(body.parent)];
    ArticulatedData::Body& a = scratch.bodies[i];
    a.linear_acceleration =
        parent.linear_acceleration + parent.angular_acceleration.cross(pose.offset);
    a.angular_acceleration = parent.angular_acceleration;
    const double joint_acceleration =
        (a.joint_force_left - a.joint_force.dot(a.linear_acceleration) -
         a.joint_moment.dot(a.angular_acceleration)) /
        a.joint_inertia;
    nu_dot[model.column(body)] = joint_acceleration;
    (body.type == JointType::kRevolute ? a.angular_acceleration : a.linear_acceleration) +=
        joint_acceleration * pose.axis();
  }
}

}  // namespace codesign::dynamics
