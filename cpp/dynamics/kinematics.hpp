#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/model.hpp"

// Poses, velocities and Jacobians of bodies and frames. Everything is kept in world axes, positions
// relative to the base origin, so that matrices come out in the mixed convention of model.hpp
// directly and do not lose digits when the robot is far from the world origin.
// No function here allocates, apart from the constructors of the scratch structs.
namespace codesign::dynamics {

// Place of a moving body.
struct BodyPose {
  Eigen::Matrix3d R;       // world_R_body
  Eigen::Vector3d p;       // body origin from the base origin [m], world axes
  Eigen::Vector3d offset;  // body origin from the parent's origin [m], world axes
  Eigen::Vector3d axis() const { return R.col(2); }  // of the joint, world axes
};

// Room for the places of one model's bodies.
struct KinematicsData {
  explicit KinematicsData(const Model& model);
  Eigen::Vector3d base_position;  // base origin in the world [m]
  std::vector<BodyPose> bodies;
};

// Velocity of the body and its acceleration for ν̇ = 0, without gravity; of the body origin, world
// axes.
struct BodyVelocity {
  Eigen::Vector3d linear, angular;                            // [m/s], [rad/s]
  Eigen::Vector3d linear_acceleration, angular_acceleration;  // [m/s²], [rad/s²]
};

// Room for the velocities of one model's bodies.
struct VelocityData {
  explicit VelocityData(const Model& model);
  std::vector<BodyVelocity> bodies;
};

// s: joint positions (n,). Writes kin.
void forward_kinematics(const Model& model, const Pose& world_T_base,
                        const Eigen::Ref<const Eigen::VectorXd>& s, KinematicsData& kin);

// nu: (dofs,). Writes velocity.
void forward_velocities(const Model& model, const KinematicsData& kin,
                        const Eigen::Ref<const Eigen::VectorXd>& nu, VelocityData& velocity);

// World pose of a frame.
Pose frame_pose(const Model& model, const KinematicsData& kin, int frame);

// Frame origin from the base origin [m], world axes.
Eigen::Vector3d frame_offset(const Model& model, const KinematicsData& kin, int frame);

// (6, dofs): velocity of the frame's origin and angular velocity, world axes, per unit nu.
void frame_jacobian(const Model& model, const KinematicsData& kin, int frame,
                    Eigen::Ref<Matrix6Xd> J);

// J nu, without J.
Vector6d frame_velocity(const Model& model, const KinematicsData& kin, const VelocityData& velocity,
                        int frame);

// J̇ nu: acceleration of the frame's origin and angular acceleration for ν̇ = 0, world axes.
Vector6d frame_bias_acceleration(const Model& model, const KinematicsData& kin,
                                 const VelocityData& velocity, int frame);

}  // namespace codesign::dynamics
