#include <gtest/gtest.h>

#include <cmath>

#include "fem/meshing/feature_curve.hpp"

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

FeatureCurve square() {
  return FeatureCurve({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}});
}

TEST(FeatureCurve, MeasuresAnOpenLine) {
  const FeatureCurve line({{0, 0, 0}, {3, 0, 0}, {3, 4, 0}});
  EXPECT_FALSE(line.is_closed());
  EXPECT_DOUBLE_EQ(line.length(), 7.0);
  EXPECT_DOUBLE_EQ(line.position({3, 1, 0}), 4.0);
  EXPECT_DOUBLE_EQ(line.length_between({1, 0, 0}, {3, 2, 0}, true), 4.0);
  EXPECT_TRUE(line.point_at({1, 0, 0}, 3.0).isApprox(Vector3d(3, 1, 0)));
  EXPECT_TRUE(line.point_at({3, 1, 0}, -3.0).isApprox(Vector3d(1, 0, 0)));
  EXPECT_TRUE(line.point_at({3, 1, 0}, 30.0).isApprox(Vector3d(3, 4, 0)));
}

TEST(FeatureCurve, WalksAClosedLineBothWays) {
  const FeatureCurve curve = square();
  EXPECT_TRUE(curve.is_closed());
  EXPECT_DOUBLE_EQ(curve.length_between({0.5, 0, 0}, {0, 0.5, 0}, true), 3.0);
  EXPECT_DOUBLE_EQ(curve.length_between({0.5, 0, 0}, {0, 0.5, 0}, false), 1.0);
  EXPECT_TRUE(curve.point_at({0, 0.5, 0}, 1.0).isApprox(Vector3d(0.5, 0, 0)));
  EXPECT_TRUE(curve.point_at({0.5, 0, 0}, -1.0).isApprox(Vector3d(0, 0.5, 0)));
}

TEST(FeatureCurve, RecognizesThePointsItHandedOut) {
  const FeatureCurve curve = square();
  const Vector3d p = curve.point_at({0, 0, 0}, M_PI);
  EXPECT_EQ(curve.position(p), M_PI);  // bit by bit: no projection in between
}

TEST(FeatureCurve, IsCoveredByBallsOnlyIfNoGapRemains) {
  const FeatureCurve curve = square();
  const Vector3d p(0.5, 0, 0), q(1, 0.5, 0);  // a corner of the square between them
  EXPECT_TRUE(curve.is_covered(p, 0.26, q, 0.26, true));
  EXPECT_FALSE(curve.is_covered(p, 0.24, q, 0.24, true));   // the corner sticks out
  EXPECT_TRUE(curve.is_covered(p, 0.81, q, 0.01, true));    // the first reaches nearly everything
  EXPECT_FALSE(curve.is_covered(p, 0.26, q, 0.26, false));  // the long way round
  EXPECT_TRUE(curve.is_covered(q, 0.26, p, 0.26, false));
}

}  // namespace
}  // namespace codesign::fem
