#include "dynamics/plant.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "dynamics/disturbance.hpp"
#include "dynamics/drives.hpp"

namespace codesign::dynamics {

using Eigen::Vector3d;

namespace {

RobotState zero_state(const Model& model) {
  return {Pose{}, Eigen::VectorXd::Zero(model.joint_count()), Eigen::VectorXd::Zero(model.dofs())};
}

}  // namespace

Vector3d rotation_vector_rate(const Vector3d& theta, const Vector3d& omega) {
  return omega - 0.5 * theta.cross(omega) + theta.cross(theta.cross(omega)) / 12.0;
}

void displace(const Eigen::Ref<const Eigen::VectorXd>& displacement, RobotState& state) {
  state.base.p += displacement.head<3>();
  state.base.R = (exp_so3(displacement.segment<3>(3)) * state.base.R).eval();
  state.joints += displacement.tail(state.joints.size());
}

Plant::Plant(const Model& model, const FlightSettings& settings)
    : model_(scale_masses(model, body_mass_scales(settings.disturbances, model.body_count()))),
      drag_(model, settings),
      friction_(settings.friction),
      integrator_(settings.integrator),
      substeps_(settings.substeps),
      step_(settings.step / settings.torque_updates / settings.substeps),
      rotation_deadband_(settings.rotation_deadband),
      has_model_masses_(settings.disturbances.mass_scale == 1.0 &&
                        settings.disturbances.mass_deviation == 0.0 && !settings.tank),
      thrust_scale_(
          thrust_scales(settings.disturbances, static_cast<int>(settings.actuators.size()))),
      thrust_(thrust_scale_),
      torque_(Eigen::VectorXd::Zero(model.joint_count())),
      terms_(model, settings.actuators, settings.rotor_inertia),
      joint_space_(model.joint_count()),
      stage_(zero_state(model)),
      origin_(stage_) {
  for (Eigen::VectorXd* v : {&force_, &nu_dot_, &rate_, &rate_sum_, &acceleration_sum_}) {
    v->setZero(model.dofs());
  }
  if (settings.tank) fill_tank(*settings.tank);
  jets_ = mount_jets(model, settings.actuators);
  if (!model.mimics) bodies_.emplace(model_, settings.rotor_inertia);
}

void Plant::fill_tank(const Tank& tank) {
  const Frame& frame = model_.frames[static_cast<std::size_t>(frame_index(model_, tank.frame))];
  tank_body_ = frame.body;
  full_ = model_.bodies[static_cast<std::size_t>(tank_body_)].inertia;
  fuel_position_ = frame.body_T_frame.p + frame.body_T_frame.R * tank.position;
  fuel_ = tank_size_ = tank.fuel;
  consumption_ = tank.consumption;
  const RigidInertia empty =
      full_ + RigidInertia{-tank.fuel, fuel_position_, Eigen::Matrix3d::Zero()};
  if (!(empty.mass > 0.0) || Eigen::LLT<Eigen::Matrix3d>(empty.inertia).info() != Eigen::Success) {
    throw std::invalid_argument("FlightSettings.tank: link \"" + tank.frame +
                                "\" has less mass or inertia than the fuel in it");
  }
}

// Takes the fuel of one period out of its body.
void Plant::burn() {
  if (tank_body_ == kNone) return;
  fuel_ -= consumption_ * thrust_.sum() * step_ * substeps_;
  RigidInertia& carrier = model_.bodies[static_cast<std::size_t>(tank_body_)].inertia;
  carrier = full_ + RigidInertia{std::max(fuel_, 0.0) - tank_size_, fuel_position_,
                                 Eigen::Matrix3d::Zero()};
  if (bodies_) bodies_->set_inertia(tank_body_, carrier);
}

void Plant::acceleration(const RobotState& state, const RobotTerms& terms, JointSpace& joint_space,
                         const PlantInputs& inputs) {
  thrust_ = inputs.thrust.cwiseProduct(thrust_scale_);
  force_ = -terms.bias;
  add_jet_forces(model_, terms, thrust_, force_);
  force_.head<3>() += inputs.base_force;
  drag_.add_forces(model_, terms, force_);
  const Eigen::Index joints = state.joints.size();
  add_friction(friction_, state.velocity.tail(joints), force_.tail(joints));
  if (!inputs.com_force.isZero(0.0)) add_com_force(terms, inputs.com_force, force_);
  force_.segment<3>(3) += inputs.base_moment;
  joint_space.acceleration(inputs.torque, force_, nu_dot_);
}

bool Plant::by_articulated_bodies(const RobotState& state, const PlantInputs& inputs,
                                  const PairedBodies* moved) {
  if (moved) {
    bodies_->move_with(*moved);
  } else {
    bodies_->move(state.base.R, state.joints, state.velocity);
  }
  return accelerate(*bodies_, state, inputs);
}

// bodies: with the plant's masses, at `state`, without pushes.
bool Plant::accelerate(PairedBodies& bodies, const RobotState& state, const PlantInputs& inputs) {
  thrust_ = inputs.thrust.cwiseProduct(thrust_scale_);
  push_jets(jets_, thrust_, bodies);
  bodies.push(0, inputs.base_force, inputs.base_moment);
  if (!inputs.com_force.isZero(0.0)) {
    bodies.push(0, inputs.com_force, bodies.center_of_mass().cross(inputs.com_force));
  }
  drag_.push(bodies);
  torque_ = inputs.torque;
  add_friction(friction_, state.velocity.tail(torque_.size()), torque_);
  return bodies.accelerate(torque_, nu_dot_);
}

bool Plant::acceleration(const RobotState& state, const PlantInputs& inputs,
                         const PairedBodies* moved) {
  if (bodies_) return by_articulated_bodies(state, inputs, moved);
  update_motion_terms(model_, state, terms_);
  if (!joint_space_.set_mass_matrix(terms_.mass_matrix)) return false;
  acceleration(state, terms_, joint_space_, inputs);
  return true;
}

bool Plant::advance(RobotTerms& terms, JointSpace& joint_space, const PlantInputs& inputs,
                    RobotState& state) {
  if (!has_model_masses_) return advance(inputs, state, terms.paired ? &*terms.paired : nullptr);
  for (int i = 0; i < substeps_; ++i) {
    if (i == 0 && terms.paired) {
      if (!accelerate(*terms.paired, state, inputs)) return false;
    } else if (i == 0) {
      if (!joint_space.factor()) return false;
      acceleration(state, terms, joint_space, inputs);
    } else if (!acceleration(state, inputs)) {
      return false;
    }
    if (!substep(inputs, state)) return false;
  }
  return true;
}

bool Plant::advance(const PlantInputs& inputs, RobotState& state, const PairedBodies* moved) {
  for (int i = 0; i < substeps_; ++i) {
    if (!acceleration(state, inputs, i == 0 ? moved : nullptr) || !substep(inputs, state))
      return false;
  }
  burn();
  return true;
}

// One substep from the state at which nu_dot_ holds the acceleration.
bool Plant::substep(const PlantInputs& inputs, RobotState& state) {
  if (integrator_ == Integrator::kRungeKutta4) return runge_kutta(inputs, state);
  if (integrator_ == Integrator::kEuler) rate_ = step_ * state.velocity;
  state.velocity += step_ * nu_dot_;
  if (integrator_ == Integrator::kSemiImplicitEuler) rate_ = step_ * state.velocity;
  if (rate_.segment<3>(3).norm() < rotation_deadband_) rate_.segment<3>(3).setZero();
  displace(rate_, state);
  return true;
}

// Classical Runge-Kutta in the coordinates displace() uses, centered on the state at the step's
// start; nu_dot_ holds the acceleration there.
bool Plant::runge_kutta(const PlantInputs& inputs, RobotState& state) {
  constexpr double kNode[4] = {0.0, 0.5, 0.5, 1.0};
  constexpr double kWeight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
  origin_ = state;
  rate_ = state.velocity;
  rate_sum_ = kWeight[0] * rate_;
  acceleration_sum_ = kWeight[0] * nu_dot_;
  for (int i = 1; i < 4; ++i) {
    stage_ = origin_;
    rate_ *= kNode[i] * step_;
    displace(rate_, stage_);
    stage_.velocity += kNode[i] * step_ * nu_dot_;
    if (!acceleration(stage_, inputs)) return false;
    const Vector3d theta = rate_.segment<3>(3);
    rate_ = stage_.velocity;
    rate_.segment<3>(3) = rotation_vector_rate(theta, stage_.velocity.segment<3>(3));
    rate_sum_ += kWeight[i] * rate_;
    acceleration_sum_ += kWeight[i] * nu_dot_;
  }
  rate_sum_ *= step_;
  displace(rate_sum_, state);
  state.velocity += step_ * acceleration_sum_;
  return true;
}

}  // namespace codesign::dynamics
