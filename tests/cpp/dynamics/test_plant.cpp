#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/plant.hpp"
#include "flying_robot.hpp"

namespace codesign::dynamics {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

RobotState tumbling_state(const Model& model) {
  RobotState state;
  state.base.p = Vector3d(0.0, 0.0, 2.0);
  state.base.R = exp_so3(Vector3d(0.3, -0.2, 0.5));
  state.joints = 0.3 * VectorXd::LinSpaced(model.joint_count(), -1.0, 1.0);
  state.velocity = VectorXd::LinSpaced(model.dofs(), 1.0, -1.0);
  return state;
}

class PlantTest : public ::testing::Test {
 protected:
  PlantTest()
      : model_(testing::model()),
        settings_(testing::settings()),
        inputs_{VectorXd::Zero(6), VectorXd::Zero(4), Vector3d::Zero()} {}

  RobotState fly(Integrator integrator, double step, int steps, int substeps = 1) {
    settings_.integrator = integrator;
    settings_.step = step;
    settings_.substeps = substeps;
    Plant plant(model_, settings_);
    RobotTerms terms(model_, settings_.actuators);
    JointSpace joint_space(model_.joint_count());
    RobotState state = tumbling_state(model_);
    for (int k = 0; k < steps; ++k) {
      update_terms(model_, state, terms);
      EXPECT_TRUE(joint_space.set_mass_matrix(terms.mass_matrix));
      EXPECT_TRUE(plant.advance(terms, joint_space, inputs_, state));
    }
    return state;
  }

  RobotTerms terms_at(const RobotState& state) const {
    RobotTerms terms(model_, settings_.actuators);
    update_terms(model_, state, terms);
    return terms;
  }

  double energy(const RobotState& state) const {
    KinematicsData kin(model_);
    forward_kinematics(model_, state.base, state.joints, kin);
    VelocityData velocity(model_);
    forward_velocities(model_, kin, state.velocity, velocity);
    InertiaData inertia(model_);
    compute_inertias(model_, kin, inertia);
    return kinetic_energy(model_, kin, inertia, velocity) + potential_energy(kin, inertia);
  }

  static double distance(const RobotState& a, const RobotState& b) {
    return (a.base.p - b.base.p).norm() + log_so3(a.base.R.transpose() * b.base.R).norm() +
           (a.joints - b.joints).norm() + (a.velocity - b.velocity).norm();
  }

  Model model_;
  FlightSettings settings_;
  PlantInputs inputs_;
};

TEST_F(PlantTest, BallisticFlightFallsWithGravityAndKeepsAngularMomentum) {
  const RobotTerms before = terms_at(tumbling_state(model_));
  const double time = 0.5, m = model_.total_mass;
  const RobotState after = fly(Integrator::kRungeKutta4, 0.001, 500);
  const RobotTerms terms = terms_at(after);
  const Vector3d gravity(0.0, 0.0, -kGravity);
  const Vector3d v0 = before.momentum.head<3>() / m;
  EXPECT_LT((terms.com - before.com - time * v0 - 0.5 * time * time * gravity).norm(), 1e-10);
  EXPECT_LT((terms.momentum.head<3>() / m - v0 - time * gravity).norm(), 1e-10);
  EXPECT_LT((terms.momentum - before.momentum).tail<3>().norm(), 1e-10);
}

// Under held torques and thrusts, one control step of 0.1 s cut finer and finer.
TEST_F(PlantTest, EveryIntegratorConvergesAtItsOrder) {
  inputs_.torque = VectorXd::LinSpaced(6, -4.0, 4.0);
  inputs_.thrust = VectorXd::Constant(4, 90.0);
  inputs_.base_force = Vector3d(5.0, -3.0, 1.0);
  const RobotState exact = fly(Integrator::kRungeKutta4, 0.1, 2, 400);
  struct {
    Integrator integrator;
    int substeps;
    double order;
  } const cases[] = {{Integrator::kEuler, 100, 1.0},
                     {Integrator::kSemiImplicitEuler, 100, 1.0},
                     {Integrator::kRungeKutta4, 8, 4.0}};
  for (const auto& c : cases) {
    const double coarse = distance(fly(c.integrator, 0.1, 2, c.substeps), exact);
    const double fine = distance(fly(c.integrator, 0.1, 2, 2 * c.substeps), exact);
    EXPECT_NEAR(std::log2(coarse / fine), c.order, 0.15) << "integrator " << int(c.integrator);
  }
}

TEST_F(PlantTest, EnergyDriftFallsWithTheOrder) {
  const double start = energy(tumbling_state(model_));
  const auto drift = [&](Integrator integrator, int steps) {
    return std::abs(energy(fly(integrator, 0.5 / steps, steps)) - start);
  };
  EXPECT_NEAR(std::log2(drift(Integrator::kEuler, 200) / drift(Integrator::kEuler, 400)), 1.0, 0.2);
  EXPECT_GT(std::log2(drift(Integrator::kRungeKutta4, 10) / drift(Integrator::kRungeKutta4, 20)),
            3.5);
}

TEST_F(PlantTest, FirstStageFromKnownTermsIsTheSameAsRecomputed) {
  inputs_.thrust = VectorXd::Constant(4, 90.0);
  const RobotState known = fly(Integrator::kEuler, 0.008, 10);
  settings_.disturbances.mass_scale = std::nextafter(1.0, 2.0);  // forces the plant's own terms
  const RobotState own = fly(Integrator::kEuler, 0.008, 10);
  EXPECT_LT(distance(known, own), 1e-12);
}

TEST_F(PlantTest, HeavierPlantAcceleratesLessUnderTheSameForce) {
  inputs_.base_force = Vector3d(50.0, 0.0, 0.0);
  settings_.disturbances.mass_scale = 2.0;
  const RobotTerms before = terms_at(tumbling_state(model_));
  const RobotTerms after = terms_at(fly(Integrator::kRungeKutta4, 0.1, 1, 100));
  const double change = (after.momentum[0] - before.momentum[0]) / model_.total_mass;
  EXPECT_NEAR(change, 0.1 * 50.0 / (2.0 * model_.total_mass), 1e-10);
}

TEST_F(PlantTest, RotationDeadbandHoldsASlowBase) {
  RobotState state = tumbling_state(model_);
  state.velocity.setZero();
  state.velocity[5] = 1e-4;
  for (const double deadband : {0.0, 1e-6}) {
    settings_.rotation_deadband = deadband;
    Plant plant(model_, settings_);
    RobotTerms terms = terms_at(state);
    JointSpace joint_space(6);
    ASSERT_TRUE(joint_space.set_mass_matrix(terms.mass_matrix));
    RobotState moved = state;
    ASSERT_TRUE(plant.advance(terms, joint_space, inputs_, moved));
    const double angle = log_so3(state.base.R.transpose() * moved.base.R).norm();
    EXPECT_NEAR(angle, deadband > 0.0 ? 0.0 : 8e-7, 1e-12);
  }
}

}  // namespace
}  // namespace codesign::dynamics
