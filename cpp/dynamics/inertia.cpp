#include "dynamics/inertia.hpp"

#include <Eigen/Geometry>

namespace codesign::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

InertiaData::InertiaData(const Model& model)
    : bodies(model.bodies.size()), subtrees(model.bodies.size()) {}

void compute_inertias(const Model& model, const KinematicsData& kin, InertiaData& inertia) {
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const RigidInertia& own = model.bodies[i].inertia;
    const BodyPose& pose = kin.bodies[i];
    RigidInertia& world = inertia.bodies[i];
    world.mass = own.mass;
    world.com = pose.p + pose.R * own.com;
    const Matrix3d half = pose.R * own.inertia;
    for (int row = 0; row < 3; ++row) {  // R I Rᵀ, symmetric to the last bit
      for (int column = row; column < 3; ++column) {
        world.inertia(row, column) = half.row(row).dot(pose.R.row(column));
        world.inertia(column, row) = world.inertia(row, column);
      }
    }
    inertia.subtrees[i] = world;
  }
  for (std::size_t i = model.bodies.size() - 1; i > 0; --i) {
    RigidInertia& parent = inertia.subtrees[static_cast<std::size_t>(model.bodies[i].parent)];
    parent = parent + inertia.subtrees[i];
  }
}

JointMomentum joint_momentum(const Body& body, const BodyPose& pose, const RigidInertia& subtree) {
  const Vector3d axis = body.ratio * pose.axis();
  if (body.type == JointType::kPrismatic) return {subtree.mass * axis, Vector3d::Zero()};
  return {subtree.mass * axis.cross(subtree.com - pose.p), subtree.inertia * axis};
}

}  // namespace codesign::dynamics
