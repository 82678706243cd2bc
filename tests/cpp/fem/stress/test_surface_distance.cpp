#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "fem/stress/surface_distance.hpp"
#include "fem/surface/distance.hpp"

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

struct Cloud {
  TetMesh mesh;  // boundary only: flat triangles with their middle nodes
  std::vector<double> reach;
};

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

// Small triangles all over a slab, at reaches of their own.
Cloud random_cloud(std::mt19937_64& random, int count, const Vector3d& size) {
  Cloud cloud;
  cloud.mesh.nodes.resize(6 * count, 3);
  cloud.mesh.boundary.resize(count, 6);
  for (int t = 0; t < count; ++t) {
    const Vector3d place = Vector3d::NullaryExpr([&] { return uniform(random, 0.0, 1.0); });
    for (int k = 0; k < 3; ++k) {
      const Vector3d offset = Vector3d::NullaryExpr([&] { return uniform(random, -0.02, 0.02); });
      cloud.mesh.nodes.row(6 * t + k) = (place.cwiseProduct(size) + offset).transpose();
    }
    for (int k = 0; k < 3; ++k) {
      cloud.mesh.nodes.row(6 * t + 3 + k) =
          0.5 * (cloud.mesh.nodes.row(6 * t + k) + cloud.mesh.nodes.row(6 * t + (k + 1) % 3));
    }
    for (int k = 0; k < 6; ++k) cloud.mesh.boundary(t, k) = 6 * t + k;
    cloud.reach.push_back(uniform(random, 0.0, 0.05));
  }
  return cloud;
}

// Every triangle as a whole, one after the other.
bool within_any(const Cloud& cloud, const Vector3d& point, double more) {
  for (int t = 0; t < cloud.mesh.boundary.rows(); ++t) {
    const double reach = cloud.reach[static_cast<std::size_t>(t)] + more;
    const auto corner = [&](int k) -> Vector3d { return cloud.mesh.nodes.row(6 * t + k); };
    if (reach >= 0 &&
        squared_distance_to_triangle(point, corner(0), corner(1), corner(2)) <= reach * reach) {
      return true;
    }
  }
  return false;
}

TEST(SurfaceDistance, FindsWhatASearchOfAllTrianglesFinds) {
  std::mt19937_64 random(5);
  for (const Vector3d& size :
       {Vector3d(1.0, 1.0, 1.0), Vector3d(2.0, 0.0, 0.3), Vector3d(0.0, 0.0, 0.0)}) {
    const Cloud cloud = random_cloud(random, 120, size);
    SurfaceDistance surface;
    for (int t = 0; t < cloud.mesh.boundary.rows(); ++t) {
      surface.add_triangle(cloud.mesh, t, cloud.reach[static_cast<std::size_t>(t)]);
    }
    surface.sort_pieces();
    int inside = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vector3d place = Vector3d::NullaryExpr([&] { return uniform(random, -0.1, 1.1); });
      const Vector3d point = place.cwiseProduct(size.cwiseMax(0.1));
      const double more = uniform(random, -0.03, 0.1);
      const bool expected = within_any(cloud, point, more);
      inside += expected ? 1 : 0;
      ASSERT_EQ(surface.within(point, more), expected) << point.transpose() << ", more " << more;
    }
    EXPECT_GT(inside, 100);
    EXPECT_LT(inside, 3900);
  }
}

TEST(SurfaceDistance, NothingIsWithinReachOfNoPieces) {
  SurfaceDistance surface;
  surface.sort_pieces();
  EXPECT_FALSE(surface.within(Vector3d::Zero(), 1.0));
  EXPECT_TRUE(std::isinf(surface.distance(Vector3d::Zero())));
}

}  // namespace
}  // namespace codesign::fem
