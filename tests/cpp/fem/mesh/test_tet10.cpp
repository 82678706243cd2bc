#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "box_mesh.hpp"
#include "fem/elasticity/stiffness.hpp"
#include "fem/mesh/tet10.hpp"

using namespace codesign::fem;
using Eigen::Vector3d;

namespace {

const Vector3d kCorners[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

Vector3d reference_node(int i) {
  if (i < 4) return kCorners[i];
  return 0.5 * (kCorners[kTetEdges[i - 4][0]] + kCorners[kTetEdges[i - 4][1]]);
}

TetNodes curved_tet() {
  TetNodes x;
  for (int i = 0; i < kTetNodes; ++i) {
    const Vector3d r = reference_node(i);
    x.col(i) = r + 0.1 * Vector3d(r[1] * r[1], r[2] * r[0], r[0] * r[0]);
  }
  return x;
}

}  // namespace

TEST(Tet10, ShapeFunctionsAreOneAtTheirNodeAndZeroAtTheOthers) {
  for (int i = 0; i < kTetNodes; ++i) {
    const TetValues n = tet10_values(reference_node(i));
    for (int j = 0; j < kTetNodes; ++j) EXPECT_NEAR(n[j], i == j ? 1.0 : 0.0, 1e-15);
  }
}

TEST(Tet10, ShapeFunctionsSumToOneAndTheirGradientsToZero) {
  const Vector3d xi(0.2, 0.3, 0.1);
  EXPECT_NEAR(tet10_values(xi).sum(), 1.0, 1e-15);
  EXPECT_LT(tet10_reference_gradients(xi).rowwise().sum().norm(), 1e-14);
}

TEST(Tet10, GradientsMatchFiniteDifferences) {
  const Vector3d xi(0.2, 0.3, 0.1);
  const Eigen::Vector2d eta(0.2, 0.3);
  const double h = 1e-6;
  for (int a = 0; a < 3; ++a) {
    const TetValues d =
        (tet10_values(xi + h * Vector3d::Unit(a)) - tet10_values(xi - h * Vector3d::Unit(a))) /
        (2 * h);
    EXPECT_LT((tet10_reference_gradients(xi).row(a).transpose() - d).norm(), 1e-9);
  }
  for (int a = 0; a < 2; ++a) {
    const Eigen::Vector2d step = h * Eigen::Vector2d::Unit(a);
    const Eigen::Matrix<double, 6, 1> d =
        (tri6_values(eta + step) - tri6_values(eta - step)) / (2 * h);
    EXPECT_LT((tri6_reference_gradients(eta).row(a).transpose() - d).norm(), 1e-9);
  }
}

TEST(Tet10, AQuadraticMapGivesTheExactGradientOfItsCoordinates) {
  TetPoints points;
  const TetNodes x = curved_tet();
  evaluate_tet(x, tet_rule_14(), points);
  for (int q = 0; q < points.count; ++q) {
    const Eigen::Matrix3d identity = x * points.gradients[static_cast<std::size_t>(q)].transpose();
    EXPECT_LT((identity - Eigen::Matrix3d::Identity()).norm(), 1e-13);
  }
}

TEST(Tet10, StraightElementsAreRecognized) {
  EXPECT_TRUE(is_straight(
      tet_nodes(box_mesh(3, 3, 3, [](const Vector3d& p) -> Vector3d { return 0.1 * p; }), 7)));
  EXPECT_FALSE(is_straight(curved_tet()));
}

TEST(Tet10, StiffnessHasSixRigidMotionsAndNoMore) {
  for (const bool curved : {false, true}) {
    const TetNodes x = curved ? curved_tet() : tet_nodes(box_mesh(1, 1, 1), 0);
    ElementMatrix k;
    element_stiffness(x, 1.2, 0.8, k);
    const Eigen::SelfAdjointEigenSolver<ElementMatrix> eigen(k);
    const Eigen::Matrix<double, 30, 1> values = eigen.eigenvalues();
    EXPECT_LT((k - k.transpose()).norm(), 1e-14 * k.norm());
    EXPECT_LT(values.head<6>().cwiseAbs().maxCoeff(), 1e-13 * values[29]);
    EXPECT_GT(values[6], 1e-3 * values[29]);
    for (int a = 0; a < 3; ++a) {
      Eigen::Matrix<double, 30, 1> shift, turn;
      for (int i = 0; i < kTetNodes; ++i) {
        shift.segment<3>(3 * i) = Vector3d::Unit(a);
        turn.segment<3>(3 * i) = Vector3d::Unit(a).cross(Vector3d(x.col(i)));
      }
      EXPECT_LT((k * shift).norm(), 1e-13 * k.norm());
      EXPECT_LT((k * turn).norm(), 1e-13 * k.norm());
    }
  }
}

TEST(Tet10, FacesOfAMappedBoxAreOutwardAndEncloseItsVolume) {
  const TetMesh mesh = box_mesh(2, 3, 2, [](const Vector3d& p) -> Vector3d {
    return p + 0.1 * Vector3d(p[1] * p[1], p[2] * p[0], p[0] * p[1]);
  });
  double volume = 0.0, divergence = 0.0;
  TetPoints points;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    evaluate_tet(tet_nodes(mesh, e), tet_rule_14(), points);
    for (int q = 0; q < points.count; ++q) volume += points.weights[static_cast<std::size_t>(q)];
  }
  const TriangleRule& rule = triangle_rule_12();
  for (int t = 0; t < mesh.boundary.rows(); ++t) {
    for (std::size_t q = 0; q < rule.points.size(); ++q) {
      const FacePoint p = evaluate_face(face_nodes(mesh, t), rule.points[q]);
      divergence += rule.weights[q] * p.position.dot(p.area) / 3.0;
    }
  }
  EXPECT_NEAR(volume, divergence, 1e-13);
}
