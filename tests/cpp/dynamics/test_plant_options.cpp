#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "dynamics/drag.hpp"
#include "dynamics/drives.hpp"
#include "dynamics/momentum_observer.hpp"
#include "dynamics/plant.hpp"
#include "flying_robot.hpp"

// Drives, rotors, friction, drag, fuel and the momentum observer, each against a closed form.
namespace codesign::dynamics {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

// A body with one wheel that turns about its own axis of symmetry: its motion does not move the
// base but for the reaction, which a base this heavy does not feel.
Model wheel() {
  const std::string heavy = "ixx=\"1e9\" iyy=\"1e9\" izz=\"1e9\" ixy=\"0\" ixz=\"0\" iyz=\"0\"";
  const std::string round = "ixx=\"0.02\" iyy=\"0.02\" izz=\"0.04\" ixy=\"0\" ixz=\"0\" iyz=\"0\"";
  UrdfOptions options;
  options.joints = {"turn"};
  return load_urdf("<robot name=\"wheel\">" + testing::link("base", 1e9, "0 0 0", heavy) +
                       testing::link("rim", 2.0, "0 0 0", round) +
                       testing::joint("turn", "continuous", "base", "rim", "0 0 1", "0 0 1") +
                       "</robot>",
                   options);
}

FlightSettings wheel_settings() {
  FlightSettings s;
  s.step = 0.002;
  s.duration = 1.0;
  s.integrator = Integrator::kRungeKutta4;
  s.joints = {"turn"};
  testing::set_controller(s);
  return s;
}

// Wheel speed after `time` seconds under a constant torque.
double spin(const FlightSettings& settings, double speed, double torque, double time) {
  const Model model = wheel();
  Plant plant(model, settings);
  RobotTerms terms(model, {}, settings.rotor_inertia);
  JointSpace joint_space(1);
  RobotState state{{}, VectorXd::Zero(1), VectorXd::Zero(7)};
  state.velocity[6] = speed;
  const PlantInputs inputs{VectorXd::Constant(1, torque), VectorXd(), Vector3d::Zero()};
  for (int k = 0; k < std::lround(time / settings.step); ++k) {
    update_terms(model, state, terms);
    EXPECT_TRUE(joint_space.set_mass_matrix(terms.mass_matrix));
    EXPECT_TRUE(plant.advance(terms, joint_space, inputs, state));
  }
  return state.velocity[6];
}

TEST(PlantOptions, RotorInertiaAddsToTheLinks) {
  FlightSettings settings = wheel_settings();
  EXPECT_NEAR(spin(settings, 0.0, 0.4, 1.0), 0.4 / 0.04, 1e-6);
  settings.rotor_inertia = VectorXd::Constant(1, 0.06);
  EXPECT_NEAR(spin(settings, 0.0, 0.4, 1.0), 0.4 / 0.10, 1e-6);
}

TEST(PlantOptions, ViscousFrictionSlowsExponentially) {
  FlightSettings settings = wheel_settings();
  settings.friction.viscous = VectorXd::Constant(1, 0.08);
  EXPECT_NEAR(spin(settings, 3.0, 0.0, 1.0), 3.0 * std::exp(-0.08 / 0.04), 1e-6);
}

TEST(PlantOptions, CoulombFrictionSlowsEvenlyAndHoldsAtRest) {
  FlightSettings settings = wheel_settings();
  settings.friction.coulomb = VectorXd::Constant(1, 0.08);
  EXPECT_NEAR(spin(settings, 3.0, 0.0, 1.0), 3.0 - 0.08 / 0.04, 1e-6);
  EXPECT_NEAR(spin(settings, 3.0, 0.0, 3.0), 0.0, 1e-6);
  // Below the break-away torque it creeps at slip_speed atanh(torque / coulomb).
  EXPECT_NEAR(spin(settings, 0.0, 0.04, 1.0), 0.02 * std::atanh(0.5), 1e-6);
}

TEST(PlantOptions, DelayedTorquesComeInOrder) {
  FlightSettings settings = wheel_settings();
  settings.step = 0.008;
  settings.torque_updates = 4;
  settings.delays.torque = 0.004;
  Drives drives(settings);
  for (int k = 0; k < 9; ++k) {
    EXPECT_EQ(drives.act(VectorXd::Constant(1, k))[0], std::max(0, k - 2));
  }
}

TEST(PlantOptions, LaggingTorquesFollowTheExponential) {
  FlightSettings settings = wheel_settings();
  settings.delays.torque_lag = 0.005;
  Drives drives(settings);
  EXPECT_EQ(drives.act(VectorXd::Zero(1))[0], 0.0);
  for (int k = 1; k < 9; ++k) {
    EXPECT_NEAR(drives.act(VectorXd::Ones(1))[0], 1.0 - std::exp(-k * 0.002 / 0.005), 1e-12);
  }
}

TEST(PlantOptions, DragSlowsABodyHyperbolicallyAndWindCarriesIt) {
  const Model model = testing::model();
  FlightSettings settings = testing::settings();
  settings.step = 0.01;
  settings.integrator = Integrator::kRungeKutta4;
  settings.drag = {{"trunk", {}, 0.8}};
  settings.disturbances.wind_velocity = Vector3d(0.0, 3.0, 0.0);
  const Drag drag(model, settings);
  RobotTerms terms(model, settings.actuators);
  RobotState state{{}, VectorXd::Zero(6), VectorXd::Zero(12)};
  state.velocity.head<3>() = Vector3d(4.0, 3.0, 0.0);
  update_terms(model, state, terms);
  VectorXd force = VectorXd::Zero(12);
  drag.add_forces(model, terms, force);
  // 3 m/s of wind from the side and 3 m/s along with it: only the 4 m/s forward are felt.
  EXPECT_NEAR(force[0], -0.5 * 1.225 * 0.8 * 16.0, 1e-12);
  EXPECT_NEAR(force.tail(11).norm(), 0.0, 1e-12);
  // The same through a frame far from the base: power equals force times velocity of the point.
  settings.drag = {{"l_fore", Vector3d(0.1, 0.2, -0.3), 0.8}};
  state.velocity = VectorXd::LinSpaced(12, -1.0, 1.0);
  update_terms(model, state, terms);
  force.setZero();
  Drag(model, settings).add_forces(model, terms, force);
  const int fore = frame_index(model, "l_fore");
  Matrix6Xd J(6, 12);
  frame_jacobian(model, terms.kin, fore, J);
  const Pose pose = frame_pose(model, terms.kin, fore);
  const Vector3d point_velocity =
      J.topRows<3>() * state.velocity +
      Vector3d(J.bottomRows<3>() * state.velocity).cross(pose.R * Vector3d(0.1, 0.2, -0.3));
  const Vector3d against = point_velocity - settings.disturbances.wind_velocity;
  const double power = -0.5 * 1.225 * 0.8 * against.norm() * against.dot(point_velocity);
  EXPECT_NEAR(force.dot(state.velocity), power, 1e-12);
}

TEST(PlantOptions, BurntFuelLeavesTheTank) {
  const Model model = testing::model();
  FlightSettings settings = testing::settings();
  settings.step = 0.01;
  settings.tank = Tank{"trunk", Vector3d(0.1, 0.0, 0.2), 2.0, 1e-3};
  settings.integrator = Integrator::kRungeKutta4;
  Plant plant(model, settings);
  RobotTerms terms(model, settings.actuators);
  JointSpace joint_space(6);
  RobotState state{{}, VectorXd::Zero(6), VectorXd::Zero(12)};
  const PlantInputs inputs{VectorXd::Zero(6), VectorXd::Constant(4, 100.0), Vector3d::Zero()};
  for (int k = 0; k < 100; ++k) {
    update_terms(model, state, terms);
    ASSERT_TRUE(joint_space.set_mass_matrix(terms.mass_matrix));
    ASSERT_TRUE(plant.advance(terms, joint_space, inputs, state));
  }
  EXPECT_NEAR(plant.fuel_left(), 2.0 - 1e-3 * 400.0, 1e-12);
  settings.tank->fuel = 30.0;  // the trunk has 22 kg
  EXPECT_THROW(Plant(model, settings), std::invalid_argument);
}

// A single body that thrusts straight up from its center of mass: v = T/ṁ ln(m₀/m) − g t.
TEST(PlantOptions, ARocketGainsWhatTsiolkovskySays) {
  const Model model =
      load_urdf("<robot name=\"rocket\">" +
                    testing::link("hull", 10.0, "0 0 0",
                                  "ixx=\"2\" iyy=\"2\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"") +
                    "</robot>",
                UrdfOptions{});
  FlightSettings settings = wheel_settings();
  settings.joints = {};
  settings.step = 0.001;
  settings.actuators = {Actuator{"hull", Vector3d::UnitZ(), 0.0, 0.0, 500.0, 100.0, {}}};
  settings.tank = Tank{"hull", Vector3d::Zero(), 5.0, 0.01};
  Plant plant(model, settings);
  RobotTerms terms(model, settings.actuators);
  JointSpace joint_space(0);
  RobotState state{{}, VectorXd(), VectorXd::Zero(6)};
  const PlantInputs inputs{VectorXd(), VectorXd::Constant(1, 200.0), Vector3d::Zero()};
  for (int k = 0; k < 2000; ++k) {
    update_terms(model, state, terms);
    ASSERT_TRUE(joint_space.set_mass_matrix(terms.mass_matrix));
    ASSERT_TRUE(plant.advance(terms, joint_space, inputs, state));
  }
  EXPECT_NEAR(plant.fuel_left(), 1.0, 1e-9);
  const double gained = 200.0 / 2.0 * std::log(10.0 / 6.0) - kGravity * 2.0;
  EXPECT_NEAR(state.velocity[2], gained, 0.01);  // fuel leaves at the end of each step
}

// A point mass under a constant force that the model does not know: the estimate rises like a
// first-order filter of it and is exact in the end.
TEST(MomentumObserver, EstimatesAnUnknownForceWithItsGainAsBandwidth) {
  constexpr double kStep = 0.001, kGain = 5.0;
  MomentumObserver observer(kGain, kStep);
  const Vector6d unknown = (Vector6d() << 3.0, -2.0, 1.0, 0.1, 0.2, -0.3).finished();
  const Vector6d known = (Vector6d() << 1.0, 0.0, -4.0, 0.0, 0.5, 0.0).finished();
  Vector6d momentum = Vector6d::Constant(7.0);
  for (int k = 0; k <= 4000; ++k) {
    const Vector6d& estimate = observer.update(momentum, known, known);
    const Vector6d expected = (1.0 - std::exp(-kGain * k * kStep)) * unknown;
    ASSERT_LT((estimate - expected).norm(), 4.0 * kGain * kStep) << k;
    momentum += kStep * (known + unknown);
    if (k == 4000) {
      EXPECT_LT((estimate - unknown).norm(), 1e-7);
    }
  }
}

TEST(MomentumObserver, WithoutGainSaysNothing) {
  MomentumObserver observer(0.0, 0.008);
  EXPECT_EQ(observer.update(Vector6d::Ones(), Vector6d::Ones(), Vector6d::Ones()).norm(), 0.0);
}

}  // namespace
}  // namespace codesign::dynamics
