#pragma once

#include <Eigen/Core>
#include <random>
#include <span>
#include <utility>

#include "dynamics/centroidal.hpp"
#include "dynamics/forward_dynamics.hpp"
#include "robots.hpp"

// A model at a random state, with everything that the algorithms compute, as values.
namespace codesign::dynamics::testing {

inline Eigen::VectorXd random_vector(int size, unsigned seed, double scale = 1.0) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd v(size);
  for (double& x : v) x = scale * normal(generator);
  return v;
}

struct State {
  Pose base;
  Eigen::VectorXd s, nu;
};

inline State random_state(const Model& model, unsigned seed) {
  State state;
  state.base = {exp_so3(random_vector(3, seed + 100)), random_vector(3, seed + 200)};
  state.s = random_vector(model.joint_count(), seed + 300);
  state.nu = random_vector(model.dofs(), seed + 400);
  return state;
}

// The state after the time h at constant nu (h² and higher terms as they come).
inline State moved(const Model& model, State state, double h) {
  if (!model.fixed_base) {
    state.base.p += h * state.nu.head<3>();
    state.base.R = (exp_so3(h * state.nu.segment<3>(3)) * state.base.R).eval();
  }
  state.s += h * state.nu.tail(model.joint_count());
  return state;
}

class Sample {
 public:
  Sample(const Model& model, const State& state)
      : model_(model), kin(model), velocity(model), inertia(model), forces_(model), aba_(model) {
    forward_kinematics(model, state.base, state.s, kin);
    forward_velocities(model, kin, state.nu, velocity);
    compute_inertias(model, kin, inertia);
  }

  Eigen::MatrixXd M() const {
    Eigen::MatrixXd result(model_.dofs(), model_.dofs());
    mass_matrix(model_, kin, inertia, result);
    return result;
  }
  Eigen::VectorXd bias() {
    Eigen::VectorXd result(model_.dofs());
    bias_forces(model_, kin, inertia, velocity, forces_, result);
    return result;
  }
  Eigen::VectorXd gravity() const {
    Eigen::VectorXd result(model_.dofs());
    gravity_forces(model_, kin, inertia, result);
    return result;
  }
  Eigen::VectorXd inverse(const Eigen::VectorXd& nu_dot) {
    Eigen::VectorXd result(model_.dofs());
    inverse_dynamics(model_, kin, inertia, velocity, nu_dot, forces_, result);
    return result;
  }
  Eigen::VectorXd forward(const Eigen::VectorXd& tau, std::span<const FrameWrench> wrenches = {}) {
    Eigen::VectorXd result(model_.dofs());
    forward_dynamics(model_, kin, inertia, velocity, tau, wrenches, aba_, result);
    return result;
  }
  Matrix6Xd jacobian(int frame) const {
    Matrix6Xd result(6, model_.dofs());
    frame_jacobian(model_, kin, frame, result);
    return result;
  }
  Matrix6Xd C() const {
    Matrix6Xd result(6, model_.dofs());
    centroidal_momentum_matrix(model_, kin, inertia, result);
    return result;
  }
  Eigen::MatrixXd com_jacobian() const {
    Eigen::Matrix<double, 3, Eigen::Dynamic> result(3, model_.dofs());
    center_of_mass_jacobian(model_, kin, inertia, result);
    return result;
  }
  Vector6d momentum() const { return centroidal_momentum(model_, kin, inertia, velocity); }
  double energy() const {
    return kinetic_energy(model_, kin, inertia, velocity) + potential_energy(kin, inertia);
  }

 private:
  const Model& model_;

 public:
  KinematicsData kin;
  VelocityData velocity;
  InertiaData inertia;

 private:
  ForceData forces_;
  ArticulatedData aba_;
};

inline double relative_error(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected) {
  return (found - expected).norm() / (expected.norm() + 1e-12);
}

// Models that between them have every kind of joint, base and shape of tree.
inline std::vector<Model> models() {
  std::vector<Model> all;
  for (const unsigned seed : {1U, 2U, 3U}) {
    const std::string text = random_robot(14, seed);
    all.push_back(load_urdf(text));
    all.push_back(load_urdf(text, {.fixed_base = true}));
    all.push_back(load_urdf(text, {.joints = {{"joint9", "joint2", "joint5", "joint1"}}}));
  }
  all.push_back(load_urdf(random_robot(1, 4)));    // one body
  all.push_back(load_urdf(random_robot(120, 5)));  // deep
  return all;
}

}  // namespace codesign::dynamics::testing
