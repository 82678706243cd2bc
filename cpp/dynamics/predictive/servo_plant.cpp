#include "dynamics/predictive/servo_plant.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "dynamics/disturbance.hpp"
#include "dynamics/plant.hpp"

namespace codesign::dynamics {

using Eigen::Index;
using Eigen::Vector3d;

ServoPlant::ServoPlant(const Model& model, const FlightSettings& settings)
    : model_(scale_masses(model, body_mass_scales(settings.disturbances, model.body_count()))),
      settings_(settings.servo_plant),
      actuators_(settings.actuators),
      thrust_scale_(
          thrust_scales(settings.disturbances, static_cast<int>(settings.actuators.size()))),
      damping_(settings.servo_plant.servo.passive),
      terms_(model, settings.actuators, settings.rotor_inertia),
      joint_space_(model.joint_count()),
      thrust_(thrust_scale_) {
  mass_matrix_.setZero(model.dofs(), model.dofs());
  torque_.setZero(model.joint_count());
  for (Eigen::VectorXd* v : {&force_, &nu_dot_, &rate_, &rate_sum_, &acceleration_sum_}) {
    v->setZero(model.dofs());
  }
  stage_ = {Pose{}, torque_, force_};
  origin_ = stage_;
  jet_origin_.resize(actuators_.size());
  jet_rate_ = jet_sum_ = jet_origin_;
}

Eigen::VectorXd ServoPlant::start(const RobotState& state, const std::vector<ThrustState>& jets) {
  const ServoSettings& servo = settings_.servo;
  const Index joints = state.joints.size();
  update_terms(model_, state, terms_);
  const Eigen::VectorXd inertia = terms_.mass_matrix.diagonal().tail(joints);
  damping_ = servo.passive + 2.0 * servo.damping_ratio.cwiseProduct(
                                       servo.stiffness.cwiseProduct(inertia).cwiseSqrt());
  ServoInputs inputs;
  sum_forces(jets, inputs);
  const Vector6d base_acceleration =
      terms_.mass_matrix.topLeftCorner<kBaseDofs, kBaseDofs>().llt().solve(
          force_.head<kBaseDofs>());
  const Eigen::VectorXd hold =
      terms_.mass_matrix.bottomLeftCorner(joints, kBaseDofs) * base_acceleration -
      force_.tail(joints);
  return state.joints + hold.cwiseQuotient(servo.stiffness);
}

void ServoPlant::servo_torque(const RobotState& state, const ServoInputs& inputs) {
  const Index joints = state.joints.size();
  torque_ = settings_.servo.stiffness.cwiseProduct(inputs.set_points - state.joints) -
            damping_.cwiseProduct(state.velocity.tail(joints));
}

// All forces but the servos': bias, jets, pulses and wind.
void ServoPlant::sum_forces(const std::vector<ThrustState>& jets, const ServoInputs& inputs) {
  for (std::size_t i = 0; i < jets.size(); ++i) {
    thrust_[static_cast<Index>(i)] = thrust_scale_[static_cast<Index>(i)] * jets[i].thrust;
  }
  force_ = -terms_.bias;
  add_jet_forces(model_, terms_, thrust_, force_);
  force_.head<3>() += inputs.base_force;
  force_.segment<3>(3) += inputs.base_moment;
  if (!inputs.com_force.isZero(0.0)) add_com_force(terms_, inputs.com_force, force_);
}

bool ServoPlant::evaluate(const RobotState& state, const std::vector<ThrustState>& jets,
                          const ServoInputs& inputs) {
  update_terms(model_, state, terms_);
  servo_torque(state, inputs);
  sum_forces(jets, inputs);
  return force_.allFinite();
}

bool ServoPlant::advance(const ServoInputs& inputs, double step, RobotState& state,
                         std::vector<ThrustState>& jets) {
  if (settings_.integrator == ServoIntegrator::kRungeKutta4) {
    return runge_kutta(inputs, step, state, jets);
  }
  if (!implicit_step(inputs, step, state)) return false;
  for (std::size_t i = 0; i < jets.size(); ++i) {
    jets[i] =
        dynamics::advance(actuators_[i], jets[i], inputs.throttles[static_cast<Index>(i)], step);
  }
  return true;
}

// (M + h K_d + h² K_p) Δν = h (S (τ − h K_p ṡ) + f): the servos at the end of the step.
bool ServoPlant::implicit_step(const ServoInputs&, double step, RobotState& state) {
  const Index joints = state.joints.size();
  const Eigen::VectorXd& stiffness = settings_.servo.stiffness;
  mass_matrix_ = terms_.mass_matrix;
  mass_matrix_.diagonal().tail(joints) += step * damping_ + (step * step) * stiffness;
  if (!joint_space_.set_mass_matrix(mass_matrix_)) return false;
  torque_ -= step * stiffness.cwiseProduct(state.velocity.tail(joints));
  joint_space_.acceleration(torque_, force_, nu_dot_);
  state.velocity += step * nu_dot_;
  rate_ = step * state.velocity;
  displace(rate_, state);
  return true;
}

// Classical Runge-Kutta of robot and jets together, as in Plant.
bool ServoPlant::runge_kutta(const ServoInputs& inputs, double step, RobotState& state,
                             std::vector<ThrustState>& jets) {
  constexpr double kNode[4] = {0.0, 0.5, 0.5, 1.0};
  constexpr double kWeight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
  origin_ = state;
  jet_origin_ = jets;
  rate_sum_.setZero();
  acceleration_sum_.setZero();
  for (ThrustState& sum : jet_sum_) sum = {};
  for (int i = 0; i < 4; ++i) {
    Vector3d theta = Vector3d::Zero();
    if (i == 0) {
      stage_ = origin_;
    } else {
      stage_ = origin_;
      rate_ *= kNode[i] * step;
      displace(rate_, stage_);
      theta = rate_.segment<3>(3);
      stage_.velocity += kNode[i] * step * nu_dot_;
      for (std::size_t j = 0; j < jets.size(); ++j) {
        jets[j].thrust = jet_origin_[j].thrust + kNode[i] * step * jet_rate_[j].thrust;
        jets[j].thrust_rate =
            jet_origin_[j].thrust_rate + kNode[i] * step * jet_rate_[j].thrust_rate;
      }
      if (!evaluate(stage_, jets, inputs)) return false;
    }
    if (!joint_space_.set_mass_matrix(terms_.mass_matrix)) return false;
    joint_space_.acceleration(torque_, force_, nu_dot_);
    rate_ = stage_.velocity;
    rate_.segment<3>(3) = rotation_vector_rate(theta, stage_.velocity.segment<3>(3));
    for (std::size_t j = 0; j < jets.size(); ++j) {
      jet_rate_[j] =
          thrust_state_rate(actuators_[j], jets[j], inputs.throttles[static_cast<Index>(j)]);
      jet_sum_[j].thrust += kWeight[i] * jet_rate_[j].thrust;
      jet_sum_[j].thrust_rate += kWeight[i] * jet_rate_[j].thrust_rate;
    }
    rate_sum_ += kWeight[i] * rate_;
    acceleration_sum_ += kWeight[i] * nu_dot_;
  }
  rate_sum_ *= step;
  displace(rate_sum_, state);
  state.velocity += step * acceleration_sum_;
  for (std::size_t j = 0; j < jets.size(); ++j) {
    jets[j].thrust = std::max(jet_origin_[j].thrust + step * jet_sum_[j].thrust, 0.0);
    jets[j].thrust_rate = jet_origin_[j].thrust_rate + step * jet_sum_[j].thrust_rate;
  }
  return true;
}

}  // namespace codesign::dynamics
