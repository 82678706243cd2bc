#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fem/surface/surface_check.hpp"
#include "fem/surface/surface_simplify.hpp"

namespace codesign::fem {
namespace {

constexpr double kAngle = 40.0 * M_PI / 180.0;

// A prism over a star-shaped polygon in (x, y), from z = 0 to z = height; faces bottom, top, and
// one per side.
SurfaceMesh prism(const std::vector<Eigen::Vector2d>& outline, double height) {
  const int n = static_cast<int>(outline.size());
  SurfaceMesh surface;
  surface.points.resize(2 * n, 3);
  std::vector<Eigen::RowVector3i> rows;
  for (int i = 0; i < n; ++i) {
    surface.points.row(i) << outline[static_cast<std::size_t>(i)].transpose(), 0.0;
    surface.points.row(n + i) << outline[static_cast<std::size_t>(i)].transpose(), height;
    const int j = (i + 1) % n;
    rows.emplace_back(i, j, n + j);
    rows.emplace_back(i, n + j, n + i);
    surface.face.insert(surface.face.end(), 2, 2 + i);
  }
  for (int i = 1; i + 1 < n; ++i) {
    rows.emplace_back(0, i + 1, i);
    rows.emplace_back(n, n + i, n + i + 1);
    surface.face.push_back(0);
    surface.face.push_back(1);
  }
  surface.face_names.assign(static_cast<std::size_t>(n) + 2, "");
  surface.face_names[0] = "bottom";
  surface.face_names[1] = "top";
  surface.triangles.resize(std::ssize(rows), 3);
  for (std::size_t t = 0; t < rows.size(); ++t)
    surface.triangles.row(static_cast<Eigen::Index>(t)) = rows[t];
  return surface;
}

// A square with a step of the given width in one side.
SurfaceMesh box_with_ledge(double width) {
  return prism({{0, 0}, {1, 0}, {1, 0.4}, {1 + width, 0.4}, {1 + width, 1}, {0, 1}}, 1.0);
}

TEST(SurfaceSimplify, RemovesANarrowLedge) {
  SurfaceMesh surface = box_with_ledge(8e-3);
  const SimplifyReport report = simplify_surface(surface, 5e-3, kAngle);
  EXPECT_EQ(report.collapsed, 2);
  EXPECT_GT(report.distance, 0.0);
  EXPECT_LE(report.distance, 5e-3);
  EXPECT_EQ(surface.points.rows(), 10);
  const SurfaceReport check = check_surface(surface);
  EXPECT_GT(check.shortest_edge, 0.3);
  EXPECT_NEAR(check.volume, 1.0, 1e-2);
}

TEST(SurfaceSimplify, KeepsWhatIsWiderThanTheTolerance) {
  SurfaceMesh surface = box_with_ledge(1.1e-2);
  EXPECT_EQ(simplify_surface(surface, 5e-3, kAngle).collapsed, 0);
  EXPECT_EQ(surface.points.rows(), 12);
  EXPECT_EQ(simplify_surface(surface, 0.0, kAngle).collapsed, 0);
}

TEST(SurfaceSimplify, NeverRemovesANamedFace) {
  SurfaceMesh surface = box_with_ledge(8e-3);
  surface.face_names[4] = "step";  // the narrow side itself
  simplify_surface(surface, 5e-3, kAngle);
  EXPECT_GT(face_areas(surface)[4], 0.0);
  EXPECT_NO_THROW(check_surface(surface));
}

TEST(SurfaceSimplify, DoesNotCollapseASmallSolid) {
  SurfaceMesh surface = prism({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1.0);
  simplify_surface(surface, 10.0, kAngle);  // a tolerance larger than the box
  EXPECT_NO_THROW(check_surface(surface));
}

}  // namespace
}  // namespace codesign::fem
