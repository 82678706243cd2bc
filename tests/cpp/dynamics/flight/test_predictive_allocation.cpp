// The loop of the predictive controller must not allocate: a flight ten times as long makes exactly
// as many allocations.
#include <gtest/gtest.h>

#include "allocation_count.hpp"
#include "dynamics/flight/flight.hpp"
#include "flying_robot.hpp"

namespace codesign::dynamics {
namespace {

// A jet with poles at −2 and −4 1/s and 60 N per unit of its variable.
StandardizedTurbine turbine() {
  StandardizedTurbine t;
  t.thrust_mean = 105.0, t.thrust_scale = 60.0, t.throttle_mean = 50.0, t.throttle_scale = 30.0;
  t.K_T = -8.0, t.K_D = -6.0, t.B = 8.0;
  return t;
}

FlightSettings predictive_settings() {
  FlightSettings s = testing::settings();
  s.controller = Controller::kPredictive;
  s.trajectory.clear();
  s.step = s.predictive.period = 0.005;
  for (Actuator& actuator : s.actuators) actuator.dynamics = turbine();
  s.predictive.body = "trunk";
  s.predictive.joints = s.joints;
  s.trim.emplace().joints = s.joints;
  s.initial_free_fall = false;
  s.servo_plant.servo.stiffness.setConstant(6, 3000.0);
  s.servo_plant.servo.damping_ratio.setConstant(6, 0.3);
  s.servo_plant.servo.passive.setConstant(6, 2.0);
  s.pulses = {{0.05, 0.02, Eigen::Vector3d(20.0, 0.0, 0.0), Eigen::Vector3d(0.0, 5.0, 0.0)}};
  return s;
}

long allocations(FlightSettings settings, double duration) {
  settings.duration = duration;
  const Model model = testing::model();
  const long before = allocation_count;
  const FlightLog log = simulate_flight(model, settings);
  EXPECT_EQ(log.status, FlightStatus::kCompleted) << static_cast<int>(log.failure_reason);
  return allocation_count - before;
}

TEST(PredictiveFlight, LoopDoesNotAllocate) {
  if (!kAllocationsAreCounted) GTEST_SKIP() << "malloc cannot be counted in this build";
  for (const ServoIntegrator integrator :
       {ServoIntegrator::kImplicit, ServoIntegrator::kRungeKutta4}) {
    FlightSettings settings = predictive_settings();
    settings.servo_plant.integrator = integrator;
    const long brief = allocations(settings, 0.1);
    EXPECT_GT(brief, 50);  // the counter works
    EXPECT_EQ(allocations(settings, 1.0), brief);
  }
}

TEST(PredictiveFlight, ReturnsToItsReferenceAfterAPulse) {
  FlightSettings settings = predictive_settings();
  settings.duration = 10.0;
  const FlightLog log = simulate_flight(testing::model(), settings);
  EXPECT_EQ(log.status, FlightStatus::kCompleted);
  EXPECT_GT(log.measures.max_com_error, 1e-3);
  EXPECT_LT(log.measures.final_com_error, 0.3 * log.measures.max_com_error);
  EXPECT_GT(log.measures.hover_margin, 0.2);
}

TEST(PredictiveFlight, WithoutAHoverIsLostAtItsStart) {
  FlightSettings settings = predictive_settings();
  for (Actuator& actuator : settings.actuators) actuator.thrust_max = 50.0;
  const FlightLog log = simulate_flight(testing::model(), settings);
  EXPECT_EQ(log.failure_reason, FailureReason::kNoHover);
  EXPECT_EQ(log.samples, 0);
}

}  // namespace
}  // namespace codesign::dynamics
