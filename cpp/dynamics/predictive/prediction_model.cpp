#include "dynamics/predictive/prediction_model.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace codesign::dynamics {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d rpy_rate_to_angular_velocity(const Vector3d& rpy) {
  const double cr = std::cos(rpy.x()), sr = std::sin(rpy.x());
  const double cp = std::cos(rpy.y()), sp = std::sin(rpy.y());
  Matrix3d W;
  W << 1.0, 0.0, -sp, 0.0, cr, cp * sr, 0.0, -sr, cr * cp;
  return W;
}

namespace {

// Derivative of m Rᵀ g with respect to (roll, pitch, yaw).
Matrix3d weight_derivative(double mass, const Vector3d& rpy) {
  const double cr = std::cos(rpy.x()), sr = std::sin(rpy.x());
  const double cp = std::cos(rpy.y()), sp = std::sin(rpy.y());
  Matrix3d G;
  G << 0.0, -cp, 0.0, cp * cr, -sp * sr, 0.0, -cp * sr, -sp * cr, 0.0;
  return -kGravity * mass * G;
}

}  // namespace

PredictionState::PredictionState(int jets)
    : thrust(Eigen::VectorXd::Zero(jets)), thrust_rate(Eigen::VectorXd::Zero(jets)) {}

JetPrediction linearize_jet(const StandardizedTurbine& turbine, const ThrustState& state,
                            double v) {
  const TurbineTerms terms = turbine_terms(turbine, state);
  JetPrediction jet;
  jet.constant = turbine.thrust_scale * (terms.f + terms.g * v);
  jet.per_thrust = terms.f_T + terms.g_T * v;
  jet.per_rate = terms.f_D + terms.g_D * v;
  jet.per_variable = turbine.thrust_scale * terms.g;
  jet.static_gain = 1.0 / steady_variable_slope(turbine, state.thrust);
  jet.thrust = state.thrust;
  jet.thrust_rate = state.thrust_rate;
  jet.variable = v;
  return jet;
}

PredictionModel::PredictionModel(int joint_count, int jet_count)
    : jets(static_cast<std::size_t>(jet_count)) {
  for (Matrix3d* m : {&world_R_body, &inertia, &rpy_rate, &weight_per_rpy}) m->setZero();
  for (Vector3d* v : {&angular_velocity, &rpy, &weight}) v->setZero();
  force_of_thrust.setZero(3, jet_count);
  moment_of_thrust.setZero(3, jet_count);
  force_of_joint.setZero(3, joint_count);
  moment_of_joint.setZero(3, joint_count);
}

PredictionModelBuilder::PredictionModelBuilder(const Model& model, const FlightSettings& settings)
    : model_(model),
      options_(settings.predictive.model),
      body_(frame_index(model, settings.predictive.body)) {
  std::vector<int> moved_by;  // joints between base and body
  for (int i = model.frames[static_cast<std::size_t>(body_)].body; i > 0;
       i = model.bodies[static_cast<std::size_t>(i)].parent) {
    moved_by.push_back(model.bodies[static_cast<std::size_t>(i)].joint);
  }
  for (const std::string& name : settings.predictive.joints) {
    joints_.push_back(joint_index(model, name));
    if (std::find(moved_by.begin(), moved_by.end(), joints_.back()) != moved_by.end()) {
      throw std::invalid_argument("predictive.joints: \"" + name + "\" moves the body \"" +
                                  settings.predictive.body + "\"; leave one of them out");
    }
  }
  for (const Actuator& actuator : settings.actuators) {
    const auto* turbine = std::get_if<StandardizedTurbine>(&actuator.dynamics);
    if (turbine == nullptr) {
      throw std::invalid_argument(
          "the predictive controller needs standardized turbine dynamics (throttle to thrust); "
          "actuator \"" +
          actuator.frame + "\" has others: choose a jet model of [flight.jet_models]");
    }
    turbines_.push_back(*turbine);
  }
  jet_map_.setZero(6, jet_count());
  jet_map_rate_.setZero(6, model.dofs());
}

Matrix3d PredictionModelBuilder::world_R_body(const RobotTerms& terms) const {
  const Frame& frame = model_.frames[static_cast<std::size_t>(body_)];
  return terms.kin.bodies[static_cast<std::size_t>(frame.body)].R * frame.body_T_frame.R;
}

Vector3d PredictionModelBuilder::angular_velocity(const RobotTerms& terms) const {
  const Frame& frame = model_.frames[static_cast<std::size_t>(body_)];
  return body_twist(terms, frame.body).angular;
}

Vector3d PredictionModelBuilder::body_rpy(const RobotTerms& terms, const Vector3d& near) const {
  return near + angle_difference(rotation_to_rpy(world_R_body(terms)), near);
}

void PredictionModelBuilder::measure(const RobotTerms& terms, const std::vector<ThrustState>& jets,
                                     const Vector3d& last_rpy, PredictionState& state) const {
  const Matrix3d R = world_R_body(terms);
  state.com = terms.com;
  state.linear_momentum = R.transpose() * terms.momentum.head<3>();
  state.angular_momentum = R.transpose() * terms.momentum.tail<3>();
  state.rpy = body_rpy(terms, last_rpy);
  for (std::size_t i = 0; i < jets.size(); ++i) {
    state.thrust[static_cast<Index>(i)] = jets[i].thrust;
    state.thrust_rate[static_cast<Index>(i)] = jets[i].thrust_rate;
  }
  state.com_integral.setZero();
  state.rpy_integral.setZero();
}

void PredictionModelBuilder::build(const RobotTerms& terms, const PredictionState& state,
                                   const Eigen::VectorXd& variables, PredictionModel& prediction) {
  const Matrix3d R = world_R_body(terms);
  const Matrix3d body_R_world = R.transpose();
  prediction.mass = terms.robot.mass;
  prediction.world_R_body = R;
  prediction.angular_velocity = body_R_world * angular_velocity(terms);
  prediction.inertia = body_R_world * terms.robot.inertia * R;
  prediction.rpy = state.rpy;
  const Matrix3d momentum_per_rpy_rate =
      prediction.inertia * rpy_rate_to_angular_velocity(state.rpy);
  prediction.rpy_rate = momentum_per_rpy_rate.inverse();
  prediction.weight = -prediction.mass * kGravity * body_R_world.col(2);
  prediction.weight_per_rpy.setZero();
  if (options_.gravity_coupling) {
    prediction.weight_per_rpy = weight_derivative(prediction.mass, state.rpy);
  }
  jet_map(terms, jet_map_);
  jet_map_rate(model_, terms, state.thrust, jet_map_rate_);
  for (Index i = 0; i < jet_map_.cols(); ++i) {
    prediction.force_of_thrust.col(i) = body_R_world * jet_map_.col(i).head<3>();
    prediction.moment_of_thrust.col(i) = body_R_world * jet_map_.col(i).tail<3>();
    const auto jet = static_cast<std::size_t>(i);
    prediction.jets[jet] =
        linearize_jet(turbines_[jet], {state.thrust[i], state.thrust_rate[i]}, variables[i]);
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const auto column = jet_map_rate_.col(kBaseDofs + joints_[j]);
    prediction.force_of_joint.col(static_cast<Index>(j)) = body_R_world * column.head<3>();
    prediction.moment_of_joint.col(static_cast<Index>(j)) = body_R_world * column.tail<3>();
  }
}

}  // namespace codesign::dynamics
