#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "errors.hpp"
#include "fem/smoothing/surface_smooth.hpp"
#include "fem/surface/self_intersection.hpp"
#include "fem/surface/surface_check.hpp"

namespace codesign::fem {
namespace {

constexpr double kAngle = 40.0 * M_PI / 180.0;

using Profile = std::vector<Eigen::Vector2d>;  // (radius, z), counter-clockwise

// A profile turned about z in `n` steps; a closed loop unless it starts on the axis. Face 0 is
// named "turned".
SurfaceMesh turned(const Profile& profile, int n) {
  std::vector<Eigen::RowVector3d> points;
  std::vector<std::vector<int>> rings;
  for (const Eigen::Vector2d& p : profile) {
    rings.emplace_back();
    for (int i = 0; i < n; ++i) {
      const double angle = 2.0 * M_PI * i / n;
      if (i == 0 || p.x() > 0.0)
        points.emplace_back(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y());
      rings.back().push_back(static_cast<int>(points.size()) - 1);
    }
  }
  std::vector<Eigen::RowVector3i> triangles;
  const std::size_t m = profile.size(), last = profile.front().x() > 0.0 ? m : m - 1;
  for (std::size_t j = 0; j < last; ++j)
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
      const std::size_t k = (i + 1) % static_cast<std::size_t>(n);
      const int a = rings[j][i], b = rings[j][k], c = rings[(j + 1) % m][k],
                d = rings[(j + 1) % m][i];
      if (a != b) triangles.emplace_back(a, b, c);
      if (c != d) triangles.emplace_back(a, c, d);
    }
  SurfaceMesh surface{Points(std::ssize(points), 3),
                      Triangles(std::ssize(triangles), 3),
                      std::vector<int>(triangles.size(), 0),
                      {"turned"}};
  for (std::size_t i = 0; i < points.size(); ++i)
    surface.points.row(static_cast<Eigen::Index>(i)) = points[i];
  for (std::size_t t = 0; t < triangles.size(); ++t)
    surface.triangles.row(static_cast<Eigen::Index>(t)) = triangles[t];
  return surface;
}

SurfaceMesh rod(int n) { return turned({{0, 0}, {4.5, 0}, {4.5, 130}, {0, 130}}, n); }

// Volume of the smooth surface relative to that wanted, less 1; its mesh is closed.
double volume_error(const SurfaceMesh& surface, double wanted, double angle = kAngle) {
  const SmoothSurface smooth = smooth_surface(surface, angle);
  EXPECT_EQ(smooth.report.reason, "");
  EXPECT_GT(smooth.report.facets, 0);
  EXPECT_NO_THROW(check_surface(smooth.surface));
  EXPECT_NO_THROW(check_self_intersection(smooth.surface));
  EXPECT_NEAR(smooth.report.volume_change,
              enclosed_volume(smooth.surface) / enclosed_volume(surface) - 1.0, 1e-12);
  return enclosed_volume(smooth.surface) / wanted - 1.0;
}

TEST(SurfaceSmooth, RoundsRods) {
  const double volume = M_PI * 4.5 * 4.5 * 130.0;
  EXPECT_LT(std::abs(volume_error(rod(12), volume)), 0.0451 / 10);  // literal: -4.51 %
  EXPECT_LT(std::abs(volume_error(rod(20), volume)), 0.0164 / 5);   // literal: -1.64 %
  EXPECT_LT(std::abs(volume_error(rod(8), volume, 50.0 * M_PI / 180.0)), 0.0997 / 10);
}

TEST(SurfaceSmooth, LongFacetsStayStraightAlongTheRod) {
  const SmoothSurface smooth = smooth_surface(rod(12), kAngle);
  double off = 0.0;
  for (Eigen::Index i = 0; i < smooth.surface.points.rows(); ++i) {
    const double radius = smooth.surface.points.row(i).head<2>().norm();
    if (radius > 1e-9) off = std::max(off, std::abs(radius - 4.5));
  }
  EXPECT_LT(off, 0.01);  // chords are 0.153 off
}

TEST(SurfaceSmooth, KeepsAllPointsAndFaces) {
  SurfaceMesh surface = rod(12);
  surface.face_names = {"", "end"};
  for (std::size_t t = 0; t < surface.face.size(); ++t)
    surface.face[t] = triangle_normal(surface, static_cast<Eigen::Index>(t)).z() > 0.5;
  const SmoothSurface smooth = smooth_surface(surface, kAngle);
  EXPECT_EQ(smooth.surface.points.topRows(surface.points.rows()), surface.points);
  EXPECT_EQ(smooth.surface.face_names, surface.face_names);
  EXPECT_NEAR(face_areas(smooth.surface)[1], M_PI * 4.5 * 4.5, 0.3);
  EXPECT_NEAR(face_areas(surface)[1], 60.75, 1e-9);
}

TEST(SurfaceSmooth, RoundsSpheresToriConesAndTubes) {
  Profile sphere, torus;
  for (int j = 0; j <= 6; ++j)
    sphere.emplace_back(j % 6 ? 10.0 * std::sin(M_PI * j / 6) : 0.0,
                        -10.0 * std::cos(M_PI * j / 6));
  for (int j = 0; j < 12; ++j)
    torus.emplace_back(20.0 + 6.0 * std::cos(M_PI * j / 6), 6.0 * std::sin(M_PI * j / 6));
  EXPECT_LT(std::abs(volume_error(turned(sphere, 12), 4000.0 * M_PI / 3.0)), 0.005);  // 10.9 %
  EXPECT_LT(std::abs(volume_error(turned(torus, 12), 1440.0 * M_PI * M_PI)), 0.005);  // 8.8 %
  const SurfaceMesh frustum = turned({{0, 0}, {10, 0}, {4, 15}, {0, 15}}, 12);
  EXPECT_LT(std::abs(volume_error(frustum, 780.0 * M_PI)), 0.003);  // 4.5 %
  const SurfaceMesh cone = turned({{0, 0}, {10, 0}, {0, 25}}, 12);
  EXPECT_LT(std::abs(volume_error(cone, 2500.0 * M_PI / 3.0)), 0.01);  // 4.5 %
  const SurfaceMesh tube = turned({{5, 0}, {8, 0}, {8, 10}, {5, 10}}, 12);
  EXPECT_LT(std::abs(volume_error(tube, 390.0 * M_PI)), 0.003);  // 4.5 %
}

// A shaft of radius 5 on a flange of radius 12 with a fillet of radius 3 in `k` steps.
SurfaceMesh shaft(int n, int k) {
  Profile profile{{0, 0}, {12, 0}, {12, 4}};
  for (int i = 0; i <= k; ++i)
    profile.emplace_back(8.0 - 3.0 * std::sin(M_PI * i / (2 * k)),
                         7.0 - 3.0 * std::cos(M_PI * i / (2 * k)));
  profile.emplace_back(5, 30);
  profile.emplace_back(0, 30);
  return turned(profile, n);
}

TEST(SurfaceSmooth, FlatsAndStraightLinesRunIntoFillets) {
  const double wanted = enclosed_volume(shaft(720, 180));
  for (const int k : {3, 4}) {
    const SurfaceMesh surface = shaft(12, k);
    const double literal = enclosed_volume(surface) / wanted - 1.0;
    EXPECT_LT(std::abs(volume_error(surface, wanted)), std::abs(literal) / 10) << k;
    const SmoothSurface smooth = smooth_surface(surface, kAngle);
    double off = 0.0, bulge = 0.0;
    for (Eigen::Index i = 0; i < smooth.surface.points.rows(); ++i) {
      const Eigen::RowVector3d p = smooth.surface.points.row(i);
      const double radius = p.head<2>().norm();
      if (p.z() > 7.0 + 1e-9 && radius > 1e-9) off = std::max(off, std::abs(radius - 5.0));
      if (radius > 8.0 + 1e-9 && radius < 11.5 && p.z() > 1e-9)
        bulge = std::max(bulge, std::abs(p.z() - 4.0));
    }
    EXPECT_LT(off, 0.03) << k;  // chords are 0.17 off
    EXPECT_LT(bulge, 1e-12) << k;
  }
}

// A prism over a convex outline.
SurfaceMesh prism(const Profile& outline) {
  const int n = static_cast<int>(outline.size());
  std::vector<Eigen::RowVector3i> rows;
  SurfaceMesh surface{Points(2 * n, 3), {}, {}, {""}};
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    surface.points.row(i) << outline[static_cast<std::size_t>(i)].transpose(), 0.0;
    surface.points.row(n + i) << outline[static_cast<std::size_t>(i)].transpose(), 20.0;
    rows.emplace_back(i, j, n + j);
    rows.emplace_back(i, n + j, n + i);
    if (i == 0 || j == 0) continue;
    rows.emplace_back(0, j, i);
    rows.emplace_back(n, n + i, n + j);
  }
  surface.triangles.resize(std::ssize(rows), 3);
  for (std::size_t t = 0; t < rows.size(); ++t)
    surface.triangles.row(static_cast<Eigen::Index>(t)) = rows[t];
  surface.face.assign(rows.size(), 0);
  return surface;
}

TEST(SurfaceSmooth, LeavesPolyhedraUnchanged) {
  const std::vector<Profile> outlines{
      {{0, 0}, {10, 0}, {10, 10}, {0, 10}},                // box
      {{0, 0}, {20, 0}, {20, 5}, {10, 6.76}, {0, 5}},      // roof, crease of 20 degrees
      {{0, 0}, {20, 0}, {20, 5}, {10, 5.1}, {0, 5}},       // crease of 1 degree
      {{0, 0}, {20, 0}, {20, 5}, {19, 6.73}, {0, 17.7}}};  // chamfer between two flats, 30 degrees
  for (const Profile& outline : outlines) {
    const SurfaceMesh surface = prism(outline);
    const SmoothSurface smooth = smooth_surface(surface, kAngle);
    EXPECT_EQ(smooth.surface.points, surface.points);
    EXPECT_EQ(smooth.surface.triangles, surface.triangles);
    EXPECT_EQ(smooth.report.facets, 0);
    EXPECT_EQ(smooth.report.max_distance, 0.0);
    EXPECT_NE(smooth.report.reason, "");
  }
}

TEST(SurfaceSmooth, FlatsOfARoundedBlockStayFlat) {
  Profile outline;
  const double corners[4][2] = {{35, 5}, {35, 25}, {5, 25}, {5, 5}};
  for (int c = 0; c < 4; ++c)
    for (int i = 0; i <= 3; ++i) {
      const double angle = M_PI / 2 * (c - 1 + i / 3.0);
      outline.emplace_back(corners[c][0] + 5 * std::cos(angle),
                           corners[c][1] + 5 * std::sin(angle));
    }
  const SurfaceMesh surface = prism(outline);
  const double wanted = 20.0 * (40.0 * 30.0 - (4.0 - M_PI) * 25.0);
  EXPECT_LT(std::abs(volume_error(surface, wanted)), 0.003 / 10);  // literal: -0.3 %
  const SmoothSurface smooth = smooth_surface(surface, kAngle);
  double flat = 0.0;  // area of the sides x = 0 and x = 40
  for (Eigen::Index t = 0; t < smooth.surface.triangles.rows(); ++t)
    if (std::abs(triangle_normal(smooth.surface, t).x()) > 1.0 - 1e-12)
      flat += triangle_area(smooth.surface, t);
  EXPECT_NEAR(flat, 2 * 20.0 * 20.0, 1e-9);
  EXPECT_GE(smooth.surface.points.minCoeff(), -1e-9);
  EXPECT_LE(smooth.surface.points.col(0).maxCoeff(), 40.0 + 1e-9);
}

TEST(SurfaceSmooth, RefusesOpenSurfacesAndAngles) {
  SurfaceMesh open = rod(12);
  open.triangles.conservativeResize(open.triangles.rows() - 1, 3);
  open.face.pop_back();
  EXPECT_THROW(smooth_surface(open, kAngle), MeshError);
  EXPECT_THROW(smooth_surface(rod(12), 0.0), std::invalid_argument);
  EXPECT_THROW(smooth_surface(rod(12), 2.0), std::invalid_argument);
}

}  // namespace
}  // namespace codesign::fem
