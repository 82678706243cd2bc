// The flight loop must not allocate: a flight ten times as long makes exactly as many allocations.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "allocation_count.hpp"
#include "dynamics/flight/flight.hpp"
#include "dynamics/robot_terms.hpp"
#include "flying_robot.hpp"

namespace codesign::dynamics {
namespace {

long allocations(const FlightSettings& settings, double duration,
                 const Model& model = testing::model()) {
  FlightSettings s = settings;
  s.duration = duration;
  const long before = allocation_count;
  const FlightLog log = simulate_flight(model, s);
  EXPECT_EQ(log.status, FlightStatus::kCompleted);
  return allocation_count - before;
}

class FlightAllocationTest : public ::testing::TestWithParam<Integrator> {};

TEST_P(FlightAllocationTest, LoopDoesNotAllocate) {
  if (!kAllocationsAreCounted) GTEST_SKIP() << "malloc cannot be counted in this build";
  FlightSettings settings = testing::settings();
  settings.integrator = GetParam();
  settings.disturbances.gust_deviation.setConstant(1.0);
  const long brief = allocations(settings, 0.4);
  EXPECT_GT(brief, 50);  // the counter works
  EXPECT_EQ(allocations(settings, 4.0), brief);
  settings.disturbances.mass_scale = 1.02;
  settings.substeps = 2;
  EXPECT_EQ(allocations(settings, 4.0), allocations(settings, 0.4));
  settings.torque_updates = 4;
  settings.hold_inertia = true;
  settings.gains.observer = 5.0;
  settings.rotor_inertia = settings.friction.viscous = Eigen::VectorXd::Constant(6, 0.05);
  settings.friction.coulomb = Eigen::VectorXd::Constant(6, 0.1);
  settings.delays = {0.008, 0.002, 0.001};
  settings.drag = {{"trunk", {}, 0.4}};
  settings.tank = Tank{"trunk", Eigen::Vector3d(0.0, 0.0, 0.1), 2.0, 1e-4};
  EXPECT_EQ(allocations(settings, 4.0), allocations(settings, 0.4));
}

// An indefinite mass matrix is factored with pivoting, a torque at its limit brings in the box QP.
TEST_P(FlightAllocationTest, LoopDoesNotAllocateWithAnIndefiniteMassMatrix) {
  if (!kAllocationsAreCounted) GTEST_SKIP() << "malloc cannot be counted in this build";
  const Model model = testing::unphysical_model();
  FlightSettings settings = testing::settings();
  RobotTerms terms(model, settings.actuators);
  update_terms(model, {{}, settings.initial_joints, Eigen::VectorXd::Zero(model.dofs())}, terms);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(terms.mass_matrix);
  EXPECT_LT(eigen.eigenvalues()[1], -1e-3);
  settings.integrator = GetParam();
  EXPECT_EQ(allocations(settings, 4.0, model), allocations(settings, 0.4, model));
  settings.limits.torque = 6.0;
  EXPECT_EQ(allocations(settings, 2.4, model), allocations(settings, 0.4, model));
  settings.duration = 2.4;
  EXPECT_GT(simulate_flight(model, settings).qp_iterations.col(1).maxCoeff(), 1);
}

INSTANTIATE_TEST_SUITE_P(Integrators, FlightAllocationTest,
                         ::testing::Values(Integrator::kEuler, Integrator::kRungeKutta4));

}  // namespace
}  // namespace codesign::dynamics
