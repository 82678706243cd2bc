#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "dynamics/spatial.hpp"

namespace codesign::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d random_vector(std::mt19937& generator) {
  std::normal_distribution<double> normal;
  return {normal(generator), normal(generator), normal(generator)};
}

// Rotation vectors of every kind: zero, tiny, at the border of the series, near π, random.
std::vector<Vector3d> rotation_vectors() {
  std::mt19937 generator(1);
  std::vector<Vector3d> all = {Vector3d::Zero()};
  for (const double angle :
       {1e-300, 1e-160, 1e-12, 1e-8, 9.99e-4, 1.001e-3, 1e-2, 1.0, 3.0, std::numbers::pi - 1e-3,
        std::numbers::pi - 1e-7, std::numbers::pi - 1e-10}) {
    for (int i = 0; i < 3; ++i) {
      all.push_back(angle * Vector3d::Unit(i));
      all.push_back(angle * random_vector(generator).normalized());
    }
  }
  return all;
}

TEST(Spatial, SkewGivesTheCrossProduct) {
  std::mt19937 generator(2);
  const Vector3d a = random_vector(generator), b = random_vector(generator);
  EXPECT_TRUE((skew(a) * b).isApprox(a.cross(b), 1e-15));
  EXPECT_TRUE(skew_part(skew(a)).isApprox(a, 1e-15));
  EXPECT_TRUE(skew_part(skew(a) + b * b.transpose()).isApprox(a, 1e-14));
}

TEST(Spatial, ExpIsARotationAboutItsVectorByItsNorm) {
  for (const Vector3d& v : rotation_vectors()) {
    const Matrix3d R = exp_so3(v);
    EXPECT_LT(rotation_error(R), 1e-15) << v.transpose();
    if (v.norm() < 1e-100) continue;
    const Matrix3d reference = Eigen::AngleAxisd(v.norm(), v.normalized()).toRotationMatrix();
    EXPECT_LT((R - reference).cwiseAbs().maxCoeff(), 1e-15) << v.transpose();
  }
}

TEST(Spatial, LogInvertsExp) {
  for (const Vector3d& v : rotation_vectors()) {
    const Vector3d back = log_so3(exp_so3(v));
    EXPECT_LE((back - v).norm(), 4e-15 * std::max(v.norm(), 1e-8)) << v.transpose();
  }
}

TEST(Spatial, LogOfAHalfTurnHasLengthPi) {
  for (int i = 0; i < 3; ++i) {
    Matrix3d R = -Matrix3d::Identity();
    R(i, i) = 1.0;
    EXPECT_NEAR(log_so3(R).norm(), std::numbers::pi, 1e-15);
    EXPECT_NEAR(std::abs(log_so3(R)[i]), std::numbers::pi, 1e-15);
  }
}

TEST(Spatial, RpyIsRotationAboutFixedAxes) {
  const Vector3d rpy(0.3, -0.7, 2.5);
  const Matrix3d expected = exp_so3(rpy.z() * Vector3d::UnitZ()) *
                            exp_so3(rpy.y() * Vector3d::UnitY()) *
                            exp_so3(rpy.x() * Vector3d::UnitX());
  EXPECT_TRUE(rpy_to_rotation(rpy).isApprox(expected, 1e-15));
  EXPECT_TRUE(rotation_to_rpy(expected).isApprox(rpy, 1e-14));
}

TEST(Spatial, RpyRoundTripAtGimbalLock) {
  for (const double pitch : {std::numbers::pi / 2, -std::numbers::pi / 2}) {
    const Matrix3d R = rpy_to_rotation({0.4, pitch, -1.1});
    EXPECT_LT((rpy_to_rotation(rotation_to_rpy(R)) - R).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(Spatial, PoseInverseAndProduct) {
  const Pose a{exp_so3({0.1, 0.2, -2.0}), {1.0, 2.0, 3.0}};
  const Pose b{exp_so3({-1.0, 0.5, 0.3}), {-4.0, 0.0, 1.0}};
  const Vector3d x(0.3, 0.1, -0.2);
  EXPECT_TRUE(((a * b).R * x + (a * b).p).isApprox(a.R * (b.R * x + b.p) + a.p, 1e-14));
  const Pose identity = a * inverse(a);
  EXPECT_LT((identity.R - Matrix3d::Identity()).norm(), 1e-15);
  EXPECT_LT(identity.p.norm(), 1e-14);
}

TEST(Spatial, TwoHalvesOfABoxMakeTheBox) {
  // Box 2 x 1 x 1 m of 12 kg: I = m/12 (b² + c²), cut at x = 0 into two cubes of 6 kg.
  const RigidInertia cube{6.0, Vector3d::Zero(), Matrix3d::Identity()};
  const RigidInertia left = transform({Matrix3d::Identity(), {-0.5, 0.0, 0.0}}, cube);
  const RigidInertia right = transform({exp_so3({0.5, 0.5, 0.5}), {0.5, 0.0, 0.0}}, cube);
  const RigidInertia box = left + right;
  EXPECT_DOUBLE_EQ(box.mass, 12.0);
  EXPECT_LT(box.com.norm(), 1e-15);
  EXPECT_LT((box.inertia - Matrix3d(Vector3d(2.0, 5.0, 5.0).asDiagonal())).norm(), 1e-14);
}

TEST(Spatial, AddingNothingChangesNothing) {
  const RigidInertia body{2.0, {1.0, 2.0, 3.0}, Matrix3d::Identity()};
  const RigidInertia sum = RigidInertia{} + body;
  EXPECT_EQ(sum.mass, body.mass);
  EXPECT_EQ(sum.com, body.com);
  EXPECT_EQ(sum.inertia, body.inertia);
  EXPECT_EQ((RigidInertia{} + RigidInertia{}).mass, 0.0);
}

}  // namespace
}  // namespace codesign::dynamics
