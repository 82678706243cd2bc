#include "dynamics/centroidal.hpp"

#include <Eigen/Geometry>
#include <cassert>

namespace codesign::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d center_of_mass(const KinematicsData& kin, const InertiaData& inertia) {
  return kin.base_position + inertia.subtrees[0].com;
}

void center_of_mass_jacobian(const Model& model, const KinematicsData& kin,
                             const InertiaData& inertia,
                             Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>> J) {
  assert(J.cols() == model.dofs());
  const RigidInertia& all = inertia.subtrees[0];
  const double scale = 1.0 / all.mass;
  if (!model.fixed_base) {
    J.leftCols<3>().setIdentity();
    J.middleCols<3>(3) = -skew(all.com);
  }
  J.rightCols(model.joint_count()).setZero();
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    const Body& body = model.bodies[i];
    J.col(model.column(body)) +=
        scale * joint_momentum(body, kin.bodies[i], inertia.subtrees[i]).linear;
  }
}

Vector3d center_of_mass_velocity(const Model& model, const KinematicsData& kin,
                                 const InertiaData& inertia, const VelocityData& velocity) {
  return centroidal_momentum(model, kin, inertia, velocity).head<3>() / model.total_mass;
}

void centroidal_momentum_matrix(const Model& model, const KinematicsData& kin,
                                const InertiaData& inertia, Eigen::Ref<Matrix6Xd> C) {
  assert(C.cols() == model.dofs());
  const RigidInertia& all = inertia.subtrees[0];
  if (!model.fixed_base) {
    C.leftCols<kBaseDofs>().setZero();
    C.block<3, 3>(0, 0).diagonal().setConstant(all.mass);
    C.block<3, 3>(0, 3) = skew(-all.mass * all.com);
    C.block<3, 3>(3, 3) = all.inertia;
  }
  C.rightCols(model.joint_count()).setZero();
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    const Body& body = model.bodies[i];
    const JointMomentum h = joint_momentum(body, kin.bodies[i], inertia.subtrees[i]);
    const int column = model.column(body);
    C.col(column).head<3>() += h.linear;
    C.col(column).tail<3>() += h.angular + (inertia.subtrees[i].com - all.com).cross(h.linear);
  }
}

Vector6d centroidal_momentum(const Model& model, const KinematicsData& kin,
                             const InertiaData& inertia, const VelocityData& velocity) {
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
  const Vector3d com = inertia.subtrees[0].com;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const RigidInertia& body = inertia.bodies[i];
    const BodyVelocity& v = velocity.bodies[i];
    const Vector3d l = body.mass * (v.linear + v.angular.cross(body.com - kin.bodies[i].p));
    linear += l;
    angular += body.inertia * v.angular + (body.com - com).cross(l);
  }
  Vector6d momentum;
  momentum << linear, angular;
  return momentum;
}

Vector6d centroidal_momentum_bias(const Model& model, const KinematicsData& kin,
                                  const InertiaData& inertia, const VelocityData& velocity) {
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
  const Vector3d com = inertia.subtrees[0].com;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const RigidInertia& body = inertia.bodies[i];
    const BodyVelocity& v = velocity.bodies[i];
    const Vector3d arm = body.com - kin.bodies[i].p;
    const Vector3d force = body.mass * (v.linear_acceleration + v.angular_acceleration.cross(arm) +
                                        v.angular.cross(v.angular.cross(arm)));
    linear += force;
    angular += body.inertia * v.angular_acceleration + v.angular.cross(body.inertia * v.angular) +
               (body.com - com).cross(force);
  }
  Vector6d rate;
  rate << linear, angular;
  return rate;
}

Matrix3d locked_inertia(const InertiaData& inertia) { return inertia.subtrees[0].inertia; }

double kinetic_energy(const Model& model, const KinematicsData& kin, const InertiaData& inertia,
                      const VelocityData& velocity) {
  double twice = 0.0;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const RigidInertia& body = inertia.bodies[i];
    const BodyVelocity& v = velocity.bodies[i];
    const Vector3d com_velocity = v.linear + v.angular.cross(body.com - kin.bodies[i].p);
    twice += body.mass * com_velocity.squaredNorm() + v.angular.dot(body.inertia * v.angular);
  }
  return 0.5 * twice;
}

double potential_energy(const KinematicsData& kin, const InertiaData& inertia) {
  return inertia.subtrees[0].mass * kGravity * center_of_mass(kin, inertia).z();
}

}  // namespace codesign::dynamics
