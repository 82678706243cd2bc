#include "fem/surface/surface_check.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "errors.hpp"
#include "fem/surface/stl.hpp"

namespace codesign::fem {
namespace {

constexpr double kLargestExtent = 1e4;      // m
constexpr double kSmallestExtent = 1e-7;    // m
constexpr double kDegenerateHeight = 1e-9;  // of the extent

std::string number(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string place(const Eigen::RowVector3d& p) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g) m", p.x(), p.y(), p.z());
  return text;
}

std::string edge_place(const SurfaceMesh& surface, int a, int b) {
  return "the edge from " + place(surface.points.row(a)) + " to " + place(surface.points.row(b));
}

// Whether p lies between a and b, on the line up to rounding.
bool lies_between(const Eigen::RowVector3d& p, const Eigen::RowVector3d& a,
                  const Eigen::RowVector3d& b, double resolution) {
  const double along = (p - a).dot(b - a) / (b - a).squaredNorm();
  return along > 0.0 && along < 1.0 && (p - a - along * (b - a)).norm() <= resolution &&
         (p - a).norm() > resolution && (p - b).norm() > resolution;
}

// Where a corner lies on the edge of a neighbor instead of on its end; empty if there is no such
// place among the first open edges.
std::string t_junction(const SurfaceMesh& surface, const std::vector<std::pair<int, int>>& open) {
  constexpr std::size_t kMostEdges = 1000;  // all pairs are looked at
  const double resolution = 1e-6 * extent(surface.points);
  const std::size_t count = std::min(open.size(), kMostEdges);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j) {
      const auto [a, b] = open[i];
      const Eigen::RowVector3d p = surface.points.row(open[j].first);
      if (lies_between(p, surface.points.row(a), surface.points.row(b), resolution))
        return "; the corner " + place(p) +
               " of a triangle lies on the edge of its neighbor from " +
               place(surface.points.row(a)) + " to " + place(surface.points.row(b)) +
               " (a T-junction)";
    }
  return {};
}

// Of triangles with the same three corners as an earlier one.
int count_doubled(const Triangles& triangles) {
  std::set<std::array<int, 3>> seen;
  int doubled = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    std::array<int, 3> corners{triangles(t, 0), triangles(t, 1), triangles(t, 2)};
    std::sort(corners.begin(), corners.end());
    doubled += !seen.insert(corners).second;
  }
  return doubled;
}

[[noreturn]] void fail_by_edge_of_many(const SurfaceMesh& surface, int a, int b, int triangles) {
  std::string message = "the surface is not a solid's boundary: " + std::to_string(triangles) +
                        " triangles meet at " + edge_place(surface, a, b);
  if (const int doubled = count_doubled(surface.triangles); doubled > 0)
    message += "; triangles written twice: " + std::to_string(doubled);
  throw MeshError(message);
}

// Every directed edge once, its opposite once.
void check_edges(const SurfaceMesh& surface) {
  std::unordered_map<std::uint64_t, int> uses;
  uses.reserve(static_cast<std::size_t>(3 * surface.triangles.rows()));
  const auto key = [](int a, int b) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) << 32 |
           static_cast<std::uint32_t>(b);
  };
  const auto each_edge = [&](auto visit) {
    for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t)
      for (int k = 0; k < 3; ++k)
        visit(t, surface.triangles(t, k), surface.triangles(t, (k + 1) % 3));
  };
  each_edge([&](Eigen::Index t, int a, int b) {
    if (a == b)
      throw MeshError("triangle " + std::to_string(t) + " uses the point " +
                      place(surface.points.row(a)) + " twice");
    ++uses[key(a, b)];
  });
  std::vector<std::pair<int, int>> open;
  each_edge([&](Eigen::Index, int a, int b) {
    const int same = uses[key(a, b)];
    const auto opposite = uses.find(key(b, a));
    const int back = opposite == uses.end() ? 0 : opposite->second;
    if (same == 1 && back == 1) return;
    if (same + back > 2) fail_by_edge_of_many(surface, a, b, same + back);
    if (same == 2)
      throw MeshError("two neighboring triangles are oriented against each other at " +
                      edge_place(surface, a, b));
    open.emplace_back(a, b);
  });
  if (!open.empty())
    throw MeshError("the surface is open: " + std::to_string(open.size()) +
                    " edges belong to one triangle only, the first is " +
                    edge_place(surface, open[0].first, open[0].second) + t_junction(surface, open));
}

}  // namespace

SurfaceReport check_surface(const SurfaceMesh& surface) {
  check_arrays(surface);
  const Eigen::Index count = surface.triangles.rows();
  if (count == 0) throw MeshError("the surface is empty");
  if (count > static_cast<Eigen::Index>(kMaxTriangles))
    throw MeshError("the surface has " + std::to_string(count) + " triangles; the limit is " +
                    std::to_string(kMaxTriangles));
  const double size = extent(surface.points);
  if (!(size <= kLargestExtent && size >= kSmallestExtent))
    throw MeshError("the surface is " + number("%.3g", size) +
                    " m large, outside 1e-7 m to 1e4 m: check the scale (1e-3 for millimeters)");
  check_edges(surface);

  SurfaceReport report{};
  report.volume = enclosed_volume(surface);
  report.shortest_edge = report.smallest_height = std::numeric_limits<double>::infinity();
  for (Eigen::Index t = 0; t < count; ++t) {
    const double area = triangle_area(surface, t);
    double longest = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double edge = (corner(surface, t, (k + 1) % 3) - corner(surface, t, k)).norm();
      report.shortest_edge = std::min(report.shortest_edge, edge);
      longest = std::max(longest, edge);
    }
    const double height = longest > 0.0 ? 2.0 * area / longest : 0.0;
    report.smallest_height = std::min(report.smallest_height, height);
    report.degenerate_triangles += height < kDegenerateHeight * size;
    report.area += area;
  }
  if (report.volume < 0.0)
    throw MeshError("the surface is inside-out: it encloses " +
                    number("%.4g", report.volume * 1e9) +
                    " mm³; swap two corners of every triangle");
  if (report.volume <= 1e-9 * report.area * size) throw MeshError("the surface encloses no volume");
  return report;
}

}  // namespace codesign::fem
