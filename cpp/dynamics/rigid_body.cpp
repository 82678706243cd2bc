#include "dynamics/rigid_body.hpp"

#include <Eigen/Geometry>
#include <cassert>

namespace codesign::dynamics {

using Eigen::Vector3d;

ForceData::ForceData(const Model& model)
    : accelerations(model.bodies.size()), bodies(model.bodies.size()) {}

void mass_matrix(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                 Eigen::Ref<Eigen::MatrixXd> M) {
  assert(M.rows() == model.dofs() && M.cols() == model.dofs());
  M.setZero();
  if (!model.fixed_base) {
    const RigidInertia& all = inertia.subtrees[0];
    M.diagonal().head<3>().setConstant(all.mass);
    M.block<3, 3>(3, 0) = skew(all.mass * all.com);
    M.block<3, 3>(0, 3) = M.block<3, 3>(3, 0).transpose();
    M.block<3, 3>(3, 3) = all.inertia + point_inertia(all.mass, all.com);
  }
  for (int j = model.body_count() - 1; j > 0; --j) {
    const auto body_j = static_cast<std::size_t>(j);
    const RigidInertia& subtree = inertia.subtrees[body_j];
    const JointMomentum h = joint_momentum(model.bodies[body_j], kin.bodies[body_j], subtree);
    const int column = model.column(model.bodies[body_j]);
    for (int i = j; i > 0;) {
      const Body& ancestor = model.bodies[static_cast<std::size_t>(i)];
      const BodyPose& pose = kin.bodies[static_cast<std::size_t>(i)];
      const int row = model.column(ancestor);
      const double entry =
          ancestor.ratio *
          (ancestor.type == JointType::kPrismatic
               ? pose.axis().dot(h.linear)
               : pose.axis().dot(h.angular + (subtree.com - pose.p).cross(h.linear)));
      M(row, column) += entry;
      if (i != j) M(column, row) += entry;
      i = ancestor.parent;
    }
    if (!model.fixed_base) {
      M.block<3, 1>(0, column) += h.linear;
      M.block<3, 1>(3, column) += h.angular + subtree.com.cross(h.linear);
      M.block<1, 6>(column, 0) = M.block<6, 1>(0, column).transpose();
    }
  }
}

ForceData::Wrench bias_wrench(const BodyPose& pose, const RigidInertia& body,
                              const BodyVelocity& v) {
  const Vector3d arm = body.com - pose.p;
  Vector3d acceleration = v.linear_acceleration + v.angular_acceleration.cross(arm) +
                          v.angular.cross(v.angular.cross(arm));
  acceleration.z() += kGravity;
  const Vector3d force = body.mass * acceleration;
  return {force, body.inertia * v.angular_acceleration + v.angular.cross(body.inertia * v.angular) +
                     arm.cross(force)};
}

namespace {

// Sums the wrenches from the leaves to the base and projects them on the joints.
void project_wrenches(const Model& model, const KinematicsData& kin, ForceData& forces,
                      Eigen::Ref<Eigen::VectorXd> generalized_forces) {
  generalized_forces.setZero();
  for (std::size_t i = model.bodies.size() - 1; i > 0; --i) {
    const Body& body = model.bodies[i];
    const BodyPose& pose = kin.bodies[i];
    const ForceData::Wrench& wrench = forces.bodies[i];
    ForceData::Wrench& parent = forces.bodies[static_cast<std::size_t>(body.parent)];
    generalized_forces[model.column(body)] +=
        body.ratio *
        pose.axis().dot(body.type == JointType::kRevolute ? wrench.moment : wrench.force);
    parent.force += wrench.force;
    parent.moment += wrench.moment + pose.offset.cross(wrench.force);
  }
  if (!model.fixed_base) {
    generalized_forces.head<3>() = forces.bodies[0].force;
    generalized_forces.segment<3>(3) = forces.bodies[0].moment;
  }
}

}  // namespace

void bias_forces(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                 const VelocityData& velocity, ForceData& scratch, Eigen::Ref<Eigen::VectorXd> b) {
  assert(b.size() == model.dofs());
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    scratch.bodies[i] = bias_wrench(kin.bodies[i], inertia.bodies[i], velocity.bodies[i]);
  }
  project_wrenches(model, kin, scratch, b);
}

void inverse_dynamics(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                      const VelocityData& velocity, const Eigen::Ref<const Eigen::VectorXd>& nu_dot,
                      ForceData& scratch, Eigen::Ref<Eigen::VectorXd> generalized_forces) {
  assert(nu_dot.size() == model.dofs() && generalized_forces.size() == model.dofs());
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const Body& body = model.bodies[i];
    const BodyPose& pose = kin.bodies[i];
    const RigidInertia& own = inertia.bodies[i];
    ForceData::Acceleration& a = scratch.accelerations[i];
    a = {Vector3d::Zero(), Vector3d::Zero()};
    if (i > 0) {
      const ForceData::Acceleration& parent =
          scratch.accelerations[static_cast<std::size_t>(body.parent)];
      a = {parent.linear + parent.angular.cross(pose.offset), parent.angular};
      const Vector3d joint = (body.ratio * nu_dot[model.column(body)]) * pose.axis();
      (body.type == JointType::kRevolute ? a.angular : a.linear) += joint;
    } else if (!model.fixed_base) {
      a = {nu_dot.head<3>(), nu_dot.segment<3>(3)};
    }
    const Vector3d arm = own.com - pose.p;
    const Vector3d force = own.mass * (a.linear + a.angular.cross(arm));
    ForceData::Wrench& wrench = scratch.bodies[i];
    wrench = bias_wrench(pose, own, velocity.bodies[i]);
    wrench.force += force;
    wrench.moment += own.inertia * a.angular + arm.cross(force);
  }
  project_wrenches(model, kin, scratch, generalized_forces);
}

void gravity_forces(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                    Eigen::Ref<Eigen::VectorXd> g) {
  assert(g.size() == model.dofs());
  g.setZero();
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    const Body& body = model.bodies[i];
    const RigidInertia& subtree = inertia.subtrees[i];
    const Vector3d axis = kin.bodies[i].axis();
    const double lift = body.type == JointType::kRevolute
                            ? axis.cross(subtree.com - kin.bodies[i].p).z()
                            : axis.z();
    g[model.column(body)] += body.ratio * subtree.mass * kGravity * lift;
  }
  if (!model.fixed_base) {
    const RigidInertia& all = inertia.subtrees[0];
    const Vector3d force(0.0, 0.0, all.mass * kGravity);
    g.head<3>() = force;
    g.segment<3>(3) = all.com.cross(force);
  }
}

}  // namespace codesign::dynamics
