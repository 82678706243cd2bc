#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "box_mesh.hpp"
#include "errors.hpp"
#include "fem/mesh/mesh_quality.hpp"
#include "fem/meshing/stretch.hpp"

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

Stretch along_x(double change) { return {Vector3d::Zero(), Vector3d::UnitX(), 0.25, 0.75, change}; }

TEST(Stretch, LeavesWhatLiesBeforeItsZoneAndMovesWhatLiesBehind) {
  const TetMesh mesh = box_mesh(8, 3, 3);
  for (const double change : {-0.3, 0.6}) {
    const TetMesh longer = stretched(mesh, along_x(change));
    for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) {
      const Vector3d before = mesh.nodes.row(n), after = longer.nodes.row(n);
      EXPECT_EQ(before.tail<2>(), after.tail<2>());
      if (before[0] <= 0.25) EXPECT_EQ(after[0], before[0]);
      if (before[0] >= 0.75) EXPECT_NEAR(after[0], before[0] + change, 1e-15);
    }
    EXPECT_NEAR(measure_quality(longer).volume, 1.0 + change, 1e-12);
  }
}

// A rod along the direction: its mid-edge nodes lie on the circle before and after.
TEST(Stretch, KeepsTheCurvedSidesOfAPrism) {
  const auto round = [](const Vector3d& x) -> Vector3d {
    const double radius = 1.0 + x[1], angle = x[2];
    return {x[0], radius * std::cos(angle), radius * std::sin(angle)};
  };
  const TetMesh longer = stretched(box_mesh(6, 1, 3, round), along_x(0.5));
  for (const int n : boundary_nodes(longer)) {
    const double radius = longer.nodes.row(n).tail<2>().norm();
    const bool inner = radius<1.25, outer = radius> 1.75;
    if (inner) EXPECT_NEAR(radius, 1.0, 1e-15);
    if (outer) EXPECT_NEAR(radius, 2.0, 1e-15);
  }
}

TEST(Stretch, TellsWhichElementsGetAnotherShape) {
  const TetMesh mesh = box_mesh(4, 1, 1);
  const std::vector<char> reshaped = reshaped_tets(mesh, along_x(0.1));
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    double center = 0.0;
    for (int i = 0; i < 4; ++i) center += 0.25 * mesh.nodes(mesh.tets(e, i), 0);
    EXPECT_EQ(reshaped[static_cast<std::size_t>(e)] != 0, center > 0.25 && center < 0.75);
  }
}

TEST(Stretch, RefusesWhatMakesNoBody) {
  EXPECT_THROW(check_stretch(along_x(-0.4)), std::invalid_argument);
  EXPECT_THROW(check_stretch(along_x(std::numeric_limits<double>::quiet_NaN())),
               std::invalid_argument);
  Stretch stretch = along_x(0.1);
  stretch.direction *= 2.0;
  EXPECT_THROW(check_stretch(stretch), std::invalid_argument);
  stretch = along_x(0.1);
  stretch.to = stretch.from;
  EXPECT_THROW(check_stretch(stretch), std::invalid_argument);
}

}  // namespace
}  // namespace codesign::fem
