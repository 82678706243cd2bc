#include <gtest/gtest.h>

#include <string>

#include "errors.hpp"
#include "fem/meshing/mesh_watch.hpp"

namespace codesign::fem {
namespace {

constexpr int kMany = 20'000;

// As the refinement does: sets balls, one after the other.
template <class Center>
void set_balls(MeshWatch& watch, int count, Center center) {
  for (int i = 0; i < count; ++i) watch.ball(center(i));
}

TEST(MeshWatch, BallsWithoutEndInOnePlaceAreStopped) {
  MeshWatch watch(MeshOptions{});
  watch.start_balls(SizeField{1e-3, {}});
  const auto crowded = [](int i) { return Eigen::Vector3d(1e-9 * i, 0.02, 0.0); };
  try {
    set_balls(watch, kMany, crowded);
    FAIL() << "never stopped";
  } catch (const MeshWatch::Stop& stop) {
    EXPECT_EQ(stop.limit, MeshWatch::Limit::crowd);
    const std::vector<Eigen::Vector3d> points(500, crowded(0));
    try {
      watch.report(stop.limit, SizeField{1e-3, {}}, points);
    } catch (const MeshLimitError& error) {
      EXPECT_NE(std::string(error.what()).find("of (0, 20, 0) mm"), std::string::npos)
          << error.what();
    }
  }
  watch.start_balls(SizeField{1e-3, {}});  // the next mesh counts anew
  set_balls(watch, 100, crowded);
}

TEST(MeshWatch, BallsThatSmallerElementsOnlyMultiplyAreStoppedToo) {
  MeshWatch watch(MeshOptions{});
  watch.start_balls(SizeField{1e-3, {}});
  watch.start_balls(SizeField{1e-6, {}});  // refined at a fault, whose edges meet at a tiny angle
  const auto crowded = [](int i) { return Eigen::Vector3d(2e-8 * i, 0.02, 0.0); };
  EXPECT_THROW(set_balls(watch, kMany, crowded), MeshWatch::Stop);
}

TEST(MeshWatch, AsManyBallsAlongALineAreNot) {
  MeshWatch watch(MeshOptions{});
  watch.start_balls(SizeField{1e-3, {}});
  set_balls(watch, kMany, [](int i) { return Eigen::Vector3d(1e-3 * i, 0.0, 0.0); });
}

}  // namespace
}  // namespace codesign::fem
