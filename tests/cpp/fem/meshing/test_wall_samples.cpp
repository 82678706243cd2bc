#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fem/meshing/prepared_surface.hpp"
#include "fem/meshing/wall_samples.hpp"

namespace codesign::fem {
namespace {

constexpr int kFacets = 48;
constexpr double kInner = 9e-3, kOuter = 10e-3;  // m

// A tube along x of facets as long as it is.
SurfaceMesh tube(double length) {
  SurfaceMesh surface;
  surface.face_names = {"outer", "inner", "start", "end"};
  surface.points.resize(4 * kFacets, 3);
  for (int ring = 0; ring < 4; ++ring) {
    const double radius = ring < 2 ? kOuter : kInner;
    for (int i = 0; i < kFacets; ++i) {
      const double angle = 2.0 * M_PI * i / kFacets;
      surface.points.row(ring * kFacets + i) << (ring % 2 == 0 ? 0.0 : length),
          radius * std::cos(angle), radius * std::sin(angle);
    }
  }
  std::vector<Eigen::Vector3i> triangles;
  const auto quads = [&](int a, int b, int face) {  // between two rings
    for (int i = 0; i < kFacets; ++i) {
      const int j = (i + 1) % kFacets;
      triangles.emplace_back(a * kFacets + i, a * kFacets + j, b * kFacets + j);
      triangles.emplace_back(a * kFacets + i, b * kFacets + j, b * kFacets + i);
      surface.face.insert(surface.face.end(), 2, face);
    }
  };
  quads(0, 1, 0);
  quads(3, 2, 1);
  quads(2, 0, 2);
  quads(1, 3, 3);
  surface.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    surface.triangles.row(static_cast<Eigen::Index>(t)) = triangles[t].transpose();
  return surface;
}

TEST(WallSamples, LongFacetsOfATubeAreSampledAtHalfItsWallAndNoFiner) {
  const SurfaceMesh surface = tube(0.3);
  ASSERT_GT(enclosed_volume(surface), 0.0);
  const SizeField size{3e-3, {}};
  const std::vector<WallSample> walls = find_walls(prepare_surface(surface, size, {}), 3.5e-3);
  double sampled = 0.0, area = 0.0;
  for (const WallSample& wall : walls) sampled += wall.area;
  for (const double face : face_areas(surface)) area += face;
  EXPECT_NEAR(sampled, area, 1e-6 * area);
  const double spacing = 0.5 * (kOuter - kInner);
  EXPECT_GT(static_cast<double>(walls.size()), area / (spacing * spacing));
  EXPECT_LT(static_cast<double>(walls.size()), 20.0 * area / (spacing * spacing));
}

}  // namespace
}  // namespace codesign::fem
