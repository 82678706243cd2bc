#include "dynamics/kinematics.hpp"

#include <Eigen/Geometry>
#include <cassert>
#include <cmath>

namespace codesign::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

KinematicsData::KinematicsData(const Model& model) : bodies(model.bodies.size()) {}

VelocityData::VelocityData(const Model& model) : bodies(model.bodies.size()) {}

void forward_kinematics(const Model& model, const Pose& world_T_base,
                        const Eigen::Ref<const Eigen::VectorXd>& s, KinematicsData& kin) {
  assert(s.size() == model.joint_count());
  kin.base_position = world_T_base.p;
  kin.bodies[0] = {world_T_base.R, Vector3d::Zero(), Vector3d::Zero()};
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    const Body& body = model.bodies[i];
    const BodyPose& parent = kin.bodies[static_cast<std::size_t>(body.parent)];
    BodyPose& pose = kin.bodies[i];
    const double position = body.ratio * s[body.joint] + body.offset;
    const Matrix3d R = parent.R * body.parent_T_body.R;
    pose.offset.noalias() = parent.R * body.parent_T_body.p;
    pose.R.col(2) = R.col(2);
    if (body.type == JointType::kRevolute) {
      const double sine = std::sin(position), cosine = std::cos(position);
      pose.R.col(0) = cosine * R.col(0) + sine * R.col(1);
      pose.R.col(1) = cosine * R.col(1) - sine * R.col(0);
    } else {
      pose.R.col(0) = R.col(0);
      pose.R.col(1) = R.col(1);
      pose.offset += position * R.col(2);
    }
    pose.p = parent.p + pose.offset;
  }
}

void forward_velocities(const Model& model, const KinematicsData& kin,
                        const Eigen::Ref<const Eigen::VectorXd>& nu, VelocityData& velocity) {
  assert(nu.size() == model.dofs());
  BodyVelocity& base = velocity.bodies[0];
  if (model.fixed_base) {
    base.linear.setZero();
    base.angular.setZero();
  } else {
    base.linear = nu.head<3>();
    base.angular = nu.segment<3>(3);
  }
  base.linear_acceleration.setZero();
  base.angular_acceleration.setZero();
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    const Body& body = model.bodies[i];
    const BodyVelocity& parent = velocity.bodies[static_cast<std::size_t>(body.parent)];
    const BodyPose& pose = kin.bodies[i];
    BodyVelocity& v = velocity.bodies[i];
    const Vector3d rate = (body.ratio * nu[model.column(body)]) * pose.axis();
    const Vector3d swing = parent.angular.cross(pose.offset);
    v.linear = parent.linear + swing;
    v.angular = parent.angular;
    v.linear_acceleration = parent.linear_acceleration +
                            parent.angular_acceleration.cross(pose.offset) +
                            parent.angular.cross(swing);
    v.angular_acceleration = parent.angular_acceleration;
    if (body.type == JointType::kRevolute) {
      v.angular += rate;
      v.angular_acceleration += parent.angular.cross(rate);
    } else {
      v.linear += rate;
      v.linear_acceleration += 2.0 * parent.angular.cross(rate);
    }
  }
}

Vector3d frame_offset(const Model& model, const KinematicsData& kin, int frame) {
  const Frame& f = model.frames[static_cast<std::size_t>(frame)];
  const BodyPose& pose = kin.bodies[static_cast<std::size_t>(f.body)];
  return pose.p + pose.R * f.body_T_frame.p;
}

Pose frame_pose(const Model& model, const KinematicsData& kin, int frame) {
  const Frame& f = model.frames[static_cast<std::size_t>(frame)];
  return {kin.bodies[static_cast<std::size_t>(f.body)].R * f.body_T_frame.R,
          kin.base_position + frame_offset(model, kin, frame)};
}

void frame_jacobian(const Model& model, const KinematicsData& kin, int frame,
                    Eigen::Ref<Matrix6Xd> J) {
  assert(J.cols() == model.dofs());
  const Vector3d origin = frame_offset(model, kin, frame);
  J.setZero();
  if (!model.fixed_base) {
    J.leftCols<kBaseDofs>().setIdentity();
    J.block<3, 3>(0, 3) = -skew(origin);
  }
  for (int i = model.frames[static_cast<std::size_t>(frame)].body; i > 0;) {
    const Body& body = model.bodies[static_cast<std::size_t>(i)];
    const BodyPose& pose = kin.bodies[static_cast<std::size_t>(i)];
    const int column = model.column(body);
    const Vector3d axis = body.ratio * pose.axis();
    if (body.type == JointType::kRevolute) {
      J.col(column).head<3>() += axis.cross(origin - pose.p);
      J.col(column).tail<3>() += axis;
    } else {
      J.col(column).head<3>() += axis;
    }
    i = body.parent;
  }
}

Vector6d frame_velocity(const Model& model, const KinematicsData& kin, const VelocityData& velocity,
                        int frame) {
  const Frame& f = model.frames[static_cast<std::size_t>(frame)];
  const BodyVelocity& v = velocity.bodies[static_cast<std::size_t>(f.body)];
  const Vector3d arm = kin.bodies[static_cast<std::size_t>(f.body)].R * f.body_T_frame.p;
  Vector6d twist;
  twist << v.linear + v.angular.cross(arm), v.angular;
  return twist;
}

Vector6d frame_bias_acceleration(const Model& model, const KinematicsData& kin,
                                 const VelocityData& velocity, int frame) {
  const Frame& f = model.frames[static_cast<std::size_t>(frame)];
  const BodyVelocity& v = velocity.bodies[static_cast<std::size_t>(f.body)];
  const Vector3d arm = kin.bodies[static_cast<std::size_t>(f.body)].R * f.body_T_frame.p;
  Vector6d acceleration;
  acceleration << v.linear_acceleration + v.angular_acceleration.cross(arm) +
                      v.angular.cross(v.angular.cross(arm)),
      v.angular_acceleration;
  return acceleration;
}

}  // namespace codesign::dynamics
