#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "dynamics/convex_distance.hpp"

namespace codesign::dynamics {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

Matrix3Xd box(double x, double y, double z) {
  Matrix3Xd points(3, 8);
  for (int i = 0; i < 8; ++i) {
    points.col(i) << (i & 1 ? x : -x) / 2, (i & 2 ? y : -y) / 2, (i & 4 ? z : -z) / 2;
  }
  return points;
}

Matrix3Xd prism(double radius, double length, int sides) {
  Matrix3Xd points(3, 2 * sides);
  for (int i = 0; i < 2 * sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i / 2) / sides;
    points.col(i) << radius * std::cos(angle), radius * std::sin(angle),
        (i % 2 ? length : -length) / 2;
  }
  return points;
}

Pose shifted(double x, double y, double z) { return {Eigen::Matrix3d::Identity(), {x, y, z}}; }

Pose random_pose(std::mt19937& generator, double spread) {
  std::normal_distribution<double> normal;
  const Vector3d turn(normal(generator), normal(generator), normal(generator));
  const Vector3d p(normal(generator), normal(generator), normal(generator));
  return {exp_so3(2.0 * turn), spread * p};
}

TEST(ConvexDistance, AlignedBoxesHaveTheDistanceOfTheirFaces) {
  const Matrix3Xd cube = box(1, 1, 1);
  EXPECT_NEAR(signed_distance(cube, cube, shifted(1.5, 0, 0)), 0.5, 1e-15);
  EXPECT_NEAR(signed_distance(cube, cube, shifted(1.1, 1.1, 1.1)), 0.1 * std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(signed_distance(cube, cube, shifted(1, 0, 0)), 0.0, 1e-15);
  EXPECT_NEAR(signed_distance(cube, cube, shifted(1, 1, 1)), 0.0, 1e-15);
}

TEST(ConvexDistance, OverlappingBoxesHaveTheShortestWayOutAsDepth) {
  const Matrix3Xd cube = box(1, 1, 1);
  EXPECT_NEAR(signed_distance(cube, cube, shifted(0, 0, 0)), -1.0, 1e-15);
  EXPECT_NEAR(signed_distance(cube, cube, shifted(0.3, 0.1, 0)), -0.7, 1e-15);
  EXPECT_NEAR(signed_distance(cube, cube, shifted(0.9, 0.9, 0.9)), -0.1, 1e-15);
  EXPECT_NEAR(signed_distance(cube, box(0.2, 0.4, 8), shifted(0, 0, 0)), -0.6, 1e-15);
}

TEST(ConvexDistance, PointsAndSegmentsAreHulls) {
  const Matrix3Xd point = Vector3d(0, 0, 0);
  Matrix3Xd segment(3, 2);
  segment.col(0) << -1, 0, 0;
  segment.col(1) << 1, 0, 0;
  EXPECT_NEAR(signed_distance(point, point, shifted(3, 4, 0)), 5.0, 1e-15);
  EXPECT_EQ(signed_distance(point, point, shifted(0, 0, 0)), 0.0);
  EXPECT_NEAR(signed_distance(segment, point, shifted(2, 1, 0)), std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(signed_distance(segment, point, shifted(0.3, 0.2, 0)), 0.2, 1e-15);
  EXPECT_EQ(signed_distance(segment, segment, shifted(0.5, 0, 0)), 0.0);
  EXPECT_NEAR(signed_distance(box(1, 1, 1), point, shifted(0.2, 0.1, 0)), -0.3, 1e-15);
}

TEST(ConvexDistance, TurningBothBodiesOrSwappingThemChangesNothing) {
  std::mt19937 generator(5);
  const Matrix3Xd a = box(0.1, 0.2, 0.3), b = prism(0.06, 0.3, 16);
  for (int i = 0; i < 200; ++i) {
    const Pose a_T_b = random_pose(generator, 0.12);
    const double d = signed_distance(a, b, a_T_b);
    EXPECT_NEAR(signed_distance(b, a, inverse(a_T_b)), d, 1e-9);
    const Pose turn = random_pose(generator, 0.3);
    const Matrix3Xd moved = (turn.R * a).colwise() + turn.p;
    EXPECT_NEAR(signed_distance(moved, b, turn * a_T_b), d, 1e-9);
  }
}

TEST(ConvexDistance, NoTranslationShorterThanTheDepthParts) {
  std::mt19937 generator(6);
  std::normal_distribution<double> normal;
  const Matrix3Xd a = box(0.1, 0.2, 0.3), b = prism(0.06, 0.3, 16);
  int overlapping = 0;
  for (int i = 0; i < 100; ++i) {
    const Pose a_T_b = random_pose(generator, 0.05);
    const double d = signed_distance(a, b, a_T_b);
    if (d >= 0.0) continue;
    ++overlapping;
    for (int k = 0; k < 50; ++k) {
      const Vector3d u =
          Vector3d(normal(generator), normal(generator), normal(generator)).normalized();
      Pose shifted_pose = a_T_b;
      shifted_pose.p += -0.999 * d * u;
      EXPECT_LE(signed_distance(a, b, shifted_pose), 0.0);
    }
  }
  EXPECT_GT(overlapping, 50);
}

TEST(ConvexDistance, ConcentricAndNearlyAlignedPrismsConverge) {
  const Matrix3Xd wide = prism(0.06, 0.2, 32), slim = prism(0.03, 0.4, 32);
  const double apothems = 0.09 * std::cos(std::numbers::pi / 32);
  for (const double angle : {0.0, 1e-14, 1e-11, 1e-9, 1e-8, 1e-7, 1e-6}) {
    const Pose turned{exp_so3(Vector3d(angle, 0.3 * angle, 0)), Vector3d::Zero()};
    EXPECT_NEAR(signed_distance(wide, slim, turned), -apothems, 1e-9 + angle) << angle;
  }
}

}  // namespace
}  // namespace codesign::dynamics
