#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <stdexcept>
#include <vector>

#include "fem/meshing/size_points.hpp"

namespace codesign::fem {
namespace {

TEST(SizePoints, SmallestOfAllPointsByAnyRoute) {
  std::mt19937 random(1);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  std::vector<Eigen::Vector3d> points;
  std::vector<double> sizes;
  for (int i = 0; i < 500; ++i) {
    points.emplace_back(uniform(), uniform(), uniform());
    sizes.push_back(0.01 + 0.1 * uniform());
  }
  const SizePoints field(points, sizes, 0.4);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p = 1.5 * Eigen::Vector3d(uniform(), uniform(), uniform());
    double wanted = 0.08;
    for (std::size_t k = 0; k < points.size(); ++k)
      wanted = std::min(wanted, sizes[k] + 0.4 * (points[k] - p).norm());
    EXPECT_EQ(field.size_at(p, 0.08), wanted);
    EXPECT_NEAR(field.scaled(0.5).size_at(p, 0.04), 0.5 * wanted, 1e-15);
  }
  EXPECT_EQ(field.smallest(), *std::min_element(sizes.begin(), sizes.end()));
}

TEST(SizePoints, NeedsOneSizeForEachPoint) {
  EXPECT_THROW(SizePoints({}, {}, 0.4), std::invalid_argument);
  EXPECT_THROW(SizePoints({Eigen::Vector3d::Zero()}, {1.0, 2.0}, 0.4), std::invalid_argument);
}

}  // namespace
}  // namespace codesign::fem
