#include "dynamics/rigid_body.hpp"

#include <Eigen/Geometry>
#include <cassert>

namespace codesign::dynamics {

using Eigen::Vector3d;

ForceData::ForceData(const Model& model) : bodies(model.bodies.size()) {}

void mass_matrix(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                 Eigen::Ref<Eigen::MatrixXd> M) {
  assert(M.rows() == model.dofs() && M.cols() == model.dofs());
  M.setZero();
  if (!model.fixed_base) {
    const RigidInertia& all = inertia.subtrees[0];
    M.diagonal().head<3>().setConstant(all.mass);
    M.block<3, 3>(3, 0) = skew(all.mass * all.com);
    M.block<3, 3>(0, 3) = M.block<3, 3>(3, 0).transpose();
    M.block<3, 3>(3, 3) = all.inertia - all.mass * (all.com * all.com.transpose());
    M.block<3, 3>(3, 3).diagonal().array() += all.mass * all.com.squaredNorm();
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
          ancestor.type == JointType::kPrismatic
              ? pose.axis().dot(h.linear)
              : pose.axis().dot(h.angular + (subtree.com - pose.p).cross(h.linear));
      M(row, column) = entry;
      M(column, row) = entry;
      i = ancestor.parent;
    }
    if (!model.fixed_base) {
      M.block<3, 1>(0, column) = h.linear;
      M.block<3, 1>(3, column) = h.angular + subtree.com.cross(h.linear);
      M.block<1, 6>(column, 0) = M.block<6, 1>(0, column).transpose();
    }
  }
}

namespace {

// Sums the wrenches in forces from the leaves to the base and projects them on the joints.
void project_forces(const Model& model, const KinematicsData& kin, ForceData& forces,
                    Eigen::Ref<Eigen::VectorXd> generalized) {
  for (std::size_t i = model.bodies.size() - 1; i > 0; --i) {
    const Body& body = model.bodies[i];
    const BodyPose& pose = kin.bodies[i];
    const ForceData::Wrench& wrench = forces.bodies[i];
    ForceData::Wrench& parent = forces.bodies[static_cast<std::size_t>(body.parent)];
    generalized[model.column(body)] =
        pose.axis().dot(body.type == JointType::kRevolute ? wrench.moment : wrench.force);
    parent.force += wrench.force;
    parent.moment += wrench.moment + pose.offset.cross(wrench.force);
  }
  if (!model.fixed_base) {
    generalized.head<3>() = forces.bodies[0].force;
    generalized.segment<3>(3) = forces.bodies[0].moment;
  }
}

}  // namespace

void bias_forces(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                 const VelocityData& velocity, ForceData& scratch, Eigen::Ref<Eigen::VectorXd> b) {
  assert(b.size() == model.dofs());
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const RigidInertia& body = inertia.bodies[i];
    const BodyVelocity& v = velocity.bodies[i];
    const Vector3d arm = body.com - kin.bodies[i].p;
    Vector3d acceleration = v.linear_acceleration + v.angular_acceleration.cross(arm) +
                            v.angular.cross(v.angular.cross(arm));
    acceleration.z() += kGravity;
    ForceData::Wrench& wrench = scratch.bodies[i];
    wrench.force = body.mass * acceleration;
    wrench.moment = body.inertia * v.angular_acceleration +
                    v.angular.cross(body.inertia * v.angular) + arm.cross(wrench.force);
  }
  project_forces(model, kin, scratch, b);
}

void gravity_forces(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                    Eigen::Ref<Eigen::VectorXd> g) {
  assert(g.size() == model.dofs());
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    const Body& body = model.bodies[i];
    const RigidInertia& subtree = inertia.subtrees[i];
    const Vector3d axis = kin.bodies[i].axis();
    const double lift = body.type == JointType::kRevolute
                            ? axis.cross(subtree.com - kin.bodies[i].p).z()
                            : axis.z();
    g[model.column(body)] = subtree.mass * kGravity * lift;
  }
  if (!model.fixed_base) {
    const RigidInertia& all = inertia.subtrees[0];
    const Vector3d force(0.0, 0.0, all.mass * kGravity);
    g.head<3>() = force;
    g.segment<3>(3) = all.com.cross(force);
  }
}

}  // namespace codesign::dynamics
