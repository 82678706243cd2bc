#include "dynamics/robot_terms.hpp"

#include <Eigen/Geometry>
#include <utility>

namespace codesign::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

RobotTerms::RobotTerms(const Model& model, const std::vector<Actuator>& actuators,
                       Eigen::VectorXd rotors)
    : kin(model) {
  if (model.fixed_base || model.mimics) {
    singly.emplace(model).rotor_inertia = std::move(rotors);
  } else {
    paired.emplace(model, rotors);
  }
  mass_matrix.setZero(model.dofs(), model.dofs());
  bias.setZero(model.dofs());
  momentum_matrix.setZero(6, model.dofs());
  for (const Actuator& actuator : actuators) {
    MountedActuator jet;
    jet.frame = frame_index(model, actuator.frame);
    jet.frame_axis = actuator.axis;
    jet.reaction = actuator.reaction;
    for (int i = model.frames[static_cast<std::size_t>(jet.frame)].body; i > 0;
         i = model.bodies[static_cast<std::size_t>(i)].parent) {
      jet.chain.push_back(i);
    }
    jets.push_back(jet);
  }
}

RobotTerms::Singly::Singly(const Model& model) : velocity(model), inertia(model), forces(model) {}

namespace {

void move_paired(const RobotState& state, RobotTerms& terms) {
  PairedBodies& bodies = *terms.paired;
  bodies.move(state.base.R, state.joints, state.velocity);
  terms.kin.base_position = state.base.p;
  bodies.write_poses(terms.kin.bodies);
  bodies.write_mass_matrix(terms.mass_matrix, terms.momentum_matrix, terms.robot);
  bodies.generalized_forces(terms.bias);
  terms.bias = -terms.bias;
}

void move_singly(const Model& model, const RobotState& state, RobotTerms& terms) {
  RobotTerms::Singly& bodies = *terms.singly;
  forward_kinematics(model, state.base, state.joints, terms.kin);
  forward_velocities(model, terms.kin, state.velocity, bodies.velocity);
  compute_inertias(model, terms.kin, bodies.inertia);
  mass_matrix(model, terms.kin, bodies.inertia, terms.mass_matrix);
  if (bodies.rotor_inertia.size() > 0) {
    terms.mass_matrix.diagonal().tail(model.joint_count()) += bodies.rotor_inertia;
  }
  centroidal_momentum_matrix(model, terms.kin, bodies.inertia, terms.momentum_matrix);
  bias_forces(model, terms.kin, bodies.inertia, bodies.velocity, bodies.forces, terms.bias);
  terms.robot = bodies.inertia.subtrees[0];
}

}  // namespace

void update_terms(const Model& model, const RobotState& state, RobotTerms& terms) {
  update_motion_terms(model, state, terms);
  terms.momentum.noalias() = terms.momentum_matrix * state.velocity;
}

void update_motion_terms(const Model& model, const RobotState& state, RobotTerms& terms) {
  if (terms.paired) {
    move_paired(state, terms);
  } else {
    move_singly(model, state, terms);
  }
  const Vector3d com_offset = terms.robot.com;
  terms.com = terms.kin.base_position + com_offset;
  for (MountedActuator& jet : terms.jets) {
    const Frame& frame = model.frames[static_cast<std::size_t>(jet.frame)];
    const BodyPose& body = terms.kin.bodies[static_cast<std::size_t>(frame.body)];
    jet.axis = body.R * (frame.body_T_frame.R * jet.frame_axis);
    jet.origin = body.p + body.R * frame.body_T_frame.p;
    jet.arm = jet.origin - com_offset;
  }
}

BodyTwist body_twist(const RobotTerms& terms, int body) {
  if (terms.paired)
    return {terms.paired->linear_velocity(body), terms.paired->angular_velocity(body)};
  const BodyVelocity& velocity = terms.singly->velocity.bodies[static_cast<std::size_t>(body)];
  return {velocity.linear, velocity.angular};
}

void add_jet_forces(const Model& model, const RobotTerms& terms,
                    const Eigen::Ref<const Eigen::VectorXd>& thrusts,
                    Eigen::Ref<Eigen::VectorXd> generalized) {
  for (std::size_t i = 0; i < terms.jets.size(); ++i) {
    const MountedActuator& jet = terms.jets[i];
    const Vector3d force = thrusts[static_cast<Eigen::Index>(i)] * jet.axis;
    generalized.head<3>() += force;
    const Vector3d moment = jet.reaction * force;
    generalized.segment<3>(3) += jet.origin.cross(force) + moment;
    for (const int b : jet.chain) {
      const Body& body = model.bodies[static_cast<std::size_t>(b)];
      const BodyPose& pose = terms.kin.bodies[static_cast<std::size_t>(b)];
      generalized[model.column(body)] +=
          body.ratio * (body.type == JointType::kRevolute
                            ? pose.axis().dot((jet.origin - pose.p).cross(force) + moment)
                            : pose.axis().dot(force));
    }
  }
}

void add_point_force(const Model& model, const KinematicsData& kin, int body, const Vector3d& point,
                     const Vector3d& force, Eigen::Ref<Eigen::VectorXd> generalized) {
  generalized.head<3>() += force;
  generalized.segment<3>(3) += point.cross(force);
  for (int i = body; i > 0;) {
    const Body& moved = model.bodies[static_cast<std::size_t>(i)];
    const BodyPose& pose = kin.bodies[static_cast<std::size_t>(i)];
    generalized[model.column(moved)] += moved.type == JointType::kRevolute
                                            ? pose.axis().dot((point - pose.p).cross(force))
                                            : pose.axis().dot(force);
    i = moved.parent;
  }
}

void add_com_force(const RobotTerms& terms, const Vector3d& force,
                   Eigen::Ref<Eigen::VectorXd> generalized) {
  generalized.head<3>() += force;
  generalized.segment<3>(3) += terms.robot.com.cross(force);
}

void jet_map(const RobotTerms& terms, Eigen::Ref<Matrix6Xd> A) {
  for (std::size_t i = 0; i < terms.jets.size(); ++i) {
    const MountedActuator& jet = terms.jets[i];
    const auto column = static_cast<Eigen::Index>(i);
    A.col(column).head<3>() = jet.axis;
    A.col(column).tail<3>() = jet.arm.cross(jet.axis) + jet.reaction * jet.axis;
  }
}

void jet_map_rate(const Model& model, const RobotTerms& terms,
                  const Eigen::Ref<const Eigen::VectorXd>& thrusts, Eigen::Ref<Matrix6Xd> Lambda) {
  // The base carries the whole robot: its translation changes nothing, its rotation turns A T.
  Vector3d total = Vector3d::Zero(), moment = Vector3d::Zero();
  for (std::size_t i = 0; i < terms.jets.size(); ++i) {
    const MountedActuator& jet = terms.jets[i];
    const Vector3d force = thrusts[static_cast<Eigen::Index>(i)] * jet.axis;
    total += force;
    moment += jet.arm.cross(force) + jet.reaction * force;
  }
  Lambda.leftCols<3>().setZero();
  Lambda.block<3, 3>(0, 3) = -skew(total);
  Lambda.block<3, 3>(3, 3) = -skew(moment);
  // Every jet's arm shortens with the velocity of the center of mass: −Σ Tᵢ S(aᵢ)(−J_c).
  const Vector3d per_mass = (1.0 / terms.robot.mass) * total;
  for (Eigen::Index j = kBaseDofs; j < Lambda.cols(); ++j) {
    Lambda.col(j).head<3>().setZero();
    Lambda.col(j).tail<3>() = per_mass.cross(terms.momentum_matrix.col(j).head<3>());
  }
  for (std::size_t i = 0; i < terms.jets.size(); ++i) {
    const MountedActuator& jet = terms.jets[i];
    const Vector3d force = thrusts[static_cast<Eigen::Index>(i)] * jet.axis;
    const Vector3d reaction = jet.reaction * force;
    for (const int b : jet.chain) {
      const Body& body = model.bodies[static_cast<std::size_t>(b)];
      const BodyPose& pose = terms.kin.bodies[static_cast<std::size_t>(b)];
      const Vector3d axis = body.ratio * pose.axis();
      auto column = Lambda.col(model.column(body));
      // Per unit of a coordinate: d(force) = ω × force, d(moment) = reaction ω × force, d(arm) =
      // velocity of the actuator's origin.
      if (body.type == JointType::kRevolute) {
        const Vector3d turn = axis.cross(force);
        column.head<3>() += turn;
        column.tail<3>() += jet.arm.cross(turn) + axis.cross(reaction) +
                            axis.cross(jet.origin - pose.p).cross(force);
      } else {
        column.tail<3>() += axis.cross(force);
      }
    }
  }
}

}  // namespace codesign::dynamics
