#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/disturbance.hpp"
#include "flying_robot.hpp"

namespace codesign::dynamics {
namespace {

// Published outputs of SplitMix64 for seed 1234567.
TEST(RandomStream, IsSplitMix64) {
  RandomStream random(1234567);
  for (const std::uint64_t expected :
       {6457827717110365317ULL, 3203168211198807973ULL, 9817491932198370423ULL,
        4593380528125082431ULL, 16408922859458223821ULL}) {
    EXPECT_EQ(random.next(), expected);
  }
}

TEST(RandomStream, NormalNumbersHaveUnitVarianceAndStayWithinSix) {
  RandomStream random(3);
  double sum = 0.0, squares = 0.0, fourth = 0.0, largest = 0.0;
  const int n = 200000;
  for (int i = 0; i < n; ++i) {
    const double x = random.normal();
    sum += x, squares += x * x, fourth += x * x * x * x;
    largest = std::max(largest, std::abs(x));
  }
  EXPECT_NEAR(sum / n, 0.0, 0.01);
  EXPECT_NEAR(squares / n, 1.0, 0.02);
  EXPECT_NEAR(fourth / n, 2.9, 0.06);  // 3 − 6/5/12: twelve uniform numbers
  EXPECT_LT(largest, 6.0);
}

TEST(Gusts, HaveTheAskedDeviationAndCorrelationTime) {
  FlightSettings settings = testing::settings();
  settings.disturbances.wind_force = Eigen::Vector3d(10.0, 0.0, 0.0);
  settings.disturbances.gust_deviation = Eigen::Vector3d(4.0, 2.0, 0.0);
  settings.disturbances.gust_time = 0.5;
  Gusts gusts(settings);
  const int n = 400000, lag = 62;  // 0.5 s
  const double step = 0.5 / lag;
  std::vector<double> x(n);
  double mean = 0.0;
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector3d force = gusts.at(i * step);
    EXPECT_EQ(force.z(), 0.0);
    x[i] = force.x();
    mean += x[i] / n;
  }
  double variance = 0.0, covariance = 0.0;
  for (int i = 0; i + lag < n; ++i) {
    variance += (x[i] - mean) * (x[i] - mean) / (n - lag);
    covariance += (x[i] - mean) * (x[i + lag] - mean) / (n - lag);
  }
  EXPECT_NEAR(mean, 10.0, 0.2);
  EXPECT_NEAR(std::sqrt(variance), 4.0, 0.15);
  EXPECT_NEAR(covariance / variance, std::exp(-1.0), 0.04);
}

TEST(Gusts, AreTheSameAtAnyStep) {
  FlightSettings settings = testing::settings();
  settings.disturbances.gust_deviation.setConstant(5.0);
  settings.disturbances.seed = 3;
  const double step = settings.step;
  Gusts whole(settings);
  settings.step = 0.5 * step;
  Gusts half(settings);
  for (int k = 0; k < 4000; ++k) {
    const Eigen::Vector3d first = half.at(2 * k * settings.step);
    EXPECT_EQ(first, whole.at(k * step));
    half.at((2 * k + 1) * settings.step);
  }
}

// Continuous: over a step far below the interval of the nodes the force moves in proportion.
TEST(Gusts, AreLinesBetweenTheirNodes) {
  FlightSettings settings = testing::settings();
  settings.disturbances.gust_deviation.setConstant(5.0);
  Gusts gusts(settings);  // nodes every 0.05 s
  for (int node = 0; node < 100; ++node) {
    const double start = 0.05 * node;
    const Eigen::Vector3d a = gusts.at(start + 0.005), b = gusts.at(start + 0.025);
    const Eigen::Vector3d c = gusts.at(start + 0.045);
    EXPECT_LT((a + c - 2.0 * b).norm(), 1e-11);
  }
}

TEST(Disturbances, AreDrawnFromTheSeedAlone) {
  Disturbances d;
  d.mass_deviation = 0.05, d.thrust_deviation = 0.02, d.mass_scale = 1.1;
  d.seed = 7;
  const Eigen::VectorXd first = body_mass_scales(d, 8);
  EXPECT_EQ(first, body_mass_scales(d, 8));
  EXPECT_EQ(first.head(5), body_mass_scales(d, 5));
  EXPECT_EQ(thrust_scales(d, 4), thrust_scales(d, 4));
  d.seed = 8;
  EXPECT_NE(first, body_mass_scales(d, 8));
  EXPECT_NEAR(first.mean(), 1.1, 0.1);
  d.thrust_deviation = 0.0;
  EXPECT_EQ(thrust_scales(d, 4), Eigen::VectorXd::Ones(4));
  d.thrust_scale = Eigen::Vector2d(0.9, 1.2);
  EXPECT_EQ(thrust_scales(d, 2), d.thrust_scale);
}

TEST(Disturbances, ScaledModelHasScaledInertias) {
  const Model model = testing::model();
  const Eigen::VectorXd scales = Eigen::VectorXd::Constant(model.body_count(), 1.5);
  const Model scaled = scale_masses(model, scales);
  EXPECT_NEAR(scaled.total_mass, 1.5 * model.total_mass, 1e-12);
  EXPECT_TRUE(scaled.bodies[1].inertia.inertia.isApprox(1.5 * model.bodies[1].inertia.inertia));
}

}  // namespace
}  // namespace codesign::dynamics
