#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fem/surface/solid_oracle.hpp"

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

// The unit cube, two triangles per side, groups 0..5 by side (-x +x -y +y -z +z).
SurfaceMesh cube() {
  SurfaceMesh surface;
  surface.points.resize(8, 3);
  for (int i = 0; i < 8; ++i) surface.points.row(i) << i % 2, i / 2 % 2, i / 4;
  const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  surface.triangles.resize(12, 3);
  for (int q = 0; q < 6; ++q) {
    surface.triangles.row(2 * q) << quads[q][0], quads[q][1], quads[q][2];
    surface.triangles.row(2 * q + 1) << quads[q][0], quads[q][2], quads[q][3];
    surface.face.insert(surface.face.end(), 2, q);
  }
  surface.face_names = {"-x", "+x", "-y", "+y", "-z", "+z"};
  return surface;
}

// A sphere of radius 1 in longitude and latitude, with vertices on the axes.
SurfaceMesh sphere(int rings, int segments) {
  SurfaceMesh surface;
  surface.points.resize((rings - 1) * segments + 2, 3);
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < segments; ++j) {
      const double theta = M_PI * i / rings, phi = 2.0 * M_PI * j / segments;
      surface.points.row((i - 1) * segments + j) << std::sin(theta) * std::cos(phi),
          std::sin(theta) * std::sin(phi), std::cos(theta);
    }
  const int north = (rings - 1) * segments, south = north + 1;
  surface.points.row(north) << 0, 0, 1;
  surface.points.row(south) << 0, 0, -1;
  std::vector<Eigen::RowVector3i> rows;
  for (int j = 0; j < segments; ++j) {
    const int k = (j + 1) % segments;
    rows.emplace_back(north, j, k);
    rows.emplace_back(south, (rings - 2) * segments + k, (rings - 2) * segments + j);
    for (int i = 0; i + 2 < rings; ++i) {
      const int a = i * segments + j, b = i * segments + k;
      rows.emplace_back(a, a + segments, b + segments);
      rows.emplace_back(a, b + segments, b);
    }
  }
  surface.triangles.resize(std::ssize(rows), 3);
  for (std::size_t t = 0; t < rows.size(); ++t)
    surface.triangles.row(static_cast<Eigen::Index>(t)) = rows[t];
  surface.face.assign(rows.size(), 0);
  surface.face_names = {""};
  return surface;
}

TEST(SolidOracle, TellsInsideFromOutsideAlsoAboveEdgesAndVertices) {
  const SurfaceMesh surface = sphere(16, 24);
  const SolidOracle oracle(surface, surface.face);
  // Points on a grid: many of them lie exactly below vertices and edges of the sphere.
  for (int i = -12; i <= 12; ++i)
    for (int j = -12; j <= 12; ++j)
      for (int k = -12; k <= 12; ++k) {
        const Vector3d p(i / 10.0, j / 10.0, k / 10.0);
        const double radius = p.norm();
        if (radius > 0.95 && radius <= 1.0 + 1e-12) continue;  // between polyhedron and sphere
        EXPECT_EQ(oracle.contains(p), radius < 1.0) << p.transpose();
      }
}

TEST(SolidOracle, NoSegmentSlipsThroughAnEdgeOrAVertex) {
  const SurfaceMesh surface = sphere(16, 24);
  const SolidOracle oracle(surface, surface.face);
  for (Eigen::Index i = 0; i < surface.points.rows(); ++i) {
    const Vector3d vertex = surface.points.row(i).transpose();
    EXPECT_TRUE(oracle.hit(Vector3d::Zero(), 2.0 * vertex)) << i;
  }
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Vector3d middle = corner(surface, t, k) + corner(surface, t, (k + 1) % 3);
      const auto hit = oracle.hit(Vector3d(1e-3, 2e-3, -1e-3), 1.3 * middle);
      ASSERT_TRUE(hit) << t;
      EXPECT_NEAR(hit->point.norm(), 0.99, 0.02);
    }
}

TEST(SolidOracle, HitsLieOnTheSurfaceAndOnTheSegment) {
  const SurfaceMesh surface = cube();
  const SolidOracle oracle(surface, surface.face);
  const auto hit = oracle.hit({0.3, 0.4, 0.5}, {0.3, 0.4, 2.0});
  ASSERT_TRUE(hit);
  EXPECT_TRUE(hit->point.isApprox(Vector3d(0.3, 0.4, 1.0), 1e-15));
  EXPECT_EQ(surface.face[static_cast<std::size_t>(hit->triangle)], 5);
  EXPECT_FALSE(oracle.hit({0.3, 0.4, 0.5}, {0.3, 0.4, 0.9}));
  EXPECT_FALSE(oracle.hit({1.3, 0.4, 0.5}, {1.3, 0.4, 2.0}));
}

TEST(SolidOracle, TheFirstHitAmongTheTrianglesOfABoxIsTheFirstHitInIt) {
  const SurfaceMesh ball = sphere(40, 60);
  const SolidOracle oracle(ball, std::vector<int>(ball.face.size(), 0));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.2, 1.2);
  int hits = 0;
  for (int box = 0; box < 50; ++box) {
    const Vector3d middle(uniform(random), uniform(random), uniform(random));
    const Vector3d reach = Vector3d::Constant(0.5);
    const std::vector<int> nearby = oracle.in_box(middle - reach, middle + reach);
    const auto in_box = [&] {
      return (middle + 0.4 * Vector3d(uniform(random), uniform(random), uniform(random))).eval();
    };
    for (int i = 0; i < 100; ++i) {
      const Vector3d a = in_box(), b = in_box();
      const int except = i % 2 && !nearby.empty() ? nearby.front() : -1;
      const auto all = oracle.first_hit(a, b, except);
      const auto some = oracle.first_hit(a, b, except, nearby);
      ASSERT_EQ(all.has_value(), some.has_value());
      if (!all) continue;
      ++hits;
      EXPECT_EQ(all->triangle, some->triangle);
      EXPECT_EQ(all->point, some->point);
    }
  }
  EXPECT_GT(hits, 300);
}

TEST(SolidOracle, ClipsAVeryLongSegmentWithoutLosingDigits) {
  const SurfaceMesh surface = cube();
  const SolidOracle oracle(surface, surface.face);
  const auto piece = oracle.clip({0.3, 0.4, 0.5}, {0, 0, 1e12}, 0.0, 1.0);
  ASSERT_TRUE(piece);
  const auto hit = oracle.hit(piece->a, piece->b);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->point.z(), 1.0, 1e-15);
  EXPECT_FALSE(oracle.clip({3.0, 0.4, 0.5}, {0, 0, 1}, -INFINITY, INFINITY));
}

TEST(SolidOracle, NearestPointAgreesWithTheDistanceToACube) {
  const SurfaceMesh surface = cube();
  const SolidOracle oracle(surface, surface.face);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(1.0, 2.0);
  for (int i = 0; i < 100; ++i) {
    const Vector3d p(uniform(random), uniform(random), uniform(random));
    EXPECT_TRUE(oracle.nearest(p, -1).point.isApprox(Vector3d::Ones(), 1e-14));
    EXPECT_TRUE(oracle.nearest(p, 0).point.isApprox(Vector3d(0, 1, 1), 1e-14));  // face -x only
  }
  EXPECT_TRUE(oracle.nearest({0.3, 0.4, 0.9}, -1).point.isApprox(Vector3d(0.3, 0.4, 1), 1e-14));
}

}  // namespace
}  // namespace codesign::fem
