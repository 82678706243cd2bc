#include "fem/planar_regions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

constexpr double kInPlane = 2e-6;     // of the extent: rounding of coordinates in a file
constexpr double kNoCorner = 0.03;    // rad, turn of an outline that is no corner
constexpr double kAlike = 0.5;        // of the turn of a circular arc: enough to belong to it
constexpr double kNoTurn = 0.3;       // of that turn: a flat
constexpr double kWide = 2.5;         // times as wide as its neighbour: not a chord of the same arc

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Vector3d point(const SurfaceMesh& surface, int p) { return surface.points.row(p).transpose(); }

// Distance of p from the line through a and b. [m]
double from_line(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = (b - a).normalized();
  return (p - a - (p - a).dot(along) * along).norm();
}

// Width of a region measured from a line through a and b. [m]
double width_from(const SurfaceMesh& surface, const std::vector<int>& triangles, const Vector3d& a,
                  const Vector3d& b) {
  double width = 0.0;
  for (const int t : triangles)
    for (int k = 0; k < 3; ++k) width = std::max(width, from_line(corner(surface, t, k), a, b));
  return width;
}

// Triangle or convex quadrangle, points on its sides not counted.
bool has_few_corners(const SurfaceMesh& surface, const Neighbours& neighbours,
                     const PlanarRegions& regions, int region) {
  std::map<int, int> next;
  for (const int t : regions.triangles[at(region)])
    for (int k = 0; k < 3; ++k) {
      const int other = neighbours[at(t)][at(k)];
      if (other >= 0 && regions.of_triangle[at(other)] == region) continue;
      if (!next.emplace(surface.triangles(t, k), surface.triangles(t, (k + 1) % 3)).second)
        return false;  // the outline meets itself
    }
  int corners = 0;
  std::size_t steps = 0;
  int p = next.begin()->first;
  do {
    const int q = next[p], r = next[q];
    const Vector3d in = (point(surface, q) - point(surface, p)).normalized();
    const Vector3d out = (point(surface, r) - point(surface, q)).normalized();
    const double turn = std::atan2(in.cross(out).dot(regions.normal[at(region)]), in.dot(out));
    if (turn < -kNoCorner) return false;
    if (turn > kNoCorner) ++corners;
    p = q;
  } while (++steps < next.size() && p != next.begin()->first);
  return steps == next.size() && corners <= 4;  // else a hole
}

std::vector<std::vector<RegionSide>> smooth_sides(const SurfaceMesh& surface,
                                                  const Neighbours& neighbours,
                                                  const PlanarRegions& regions,
                                                  double feature_angle) {
  std::vector<std::vector<RegionSide>> sides(regions.triangles.size());
  for (std::size_t t = 0; t < neighbours.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int other = neighbours[t][at(k)];
      if (other < 0) continue;
      const int r = regions.of_triangle[t], s = regions.of_triangle[at(other)];
      const Vector3d &n = regions.normal[at(r)], &m = regions.normal[at(s)];
      const double turn = std::atan2(n.cross(m).norm(), n.dot(m));
      if (r == s || turn > feature_angle) continue;
      const auto row = static_cast<Eigen::Index>(t);
      const int from = surface.triangles(row, k), to = surface.triangles(row, (k + 1) % 3);
      const Vector3d a = point(surface, from), b = point(surface, to);
      const bool convex = n.cross(m).dot(b - a) > 0.0;
      sides[at(r)].push_back({s, from, to, convex ? turn : -turn,
                              width_from(surface, regions.triangles[at(r)], a, b),
                              width_from(surface, regions.triangles[at(s)], a, b)});
    }
  return sides;
}

double curvature(const RegionSide& side) { return 2.0 * side.turn / (side.width + side.beyond); }

// Turn [rad] of the region across a side, from its other sides; 0 if nothing is known.
double turn_across(const SurfaceMesh& surface, const RegionSide& side,
                   const std::vector<RegionSide>& of_other, const std::vector<bool>& flat) {
  const Vector3d a = point(surface, side.from), b = point(surface, side.to);
  double most = 0.0;
  for (const RegionSide& far : of_other) {
    const Vector3d middle = 0.5 * (point(surface, far.from) + point(surface, far.to));
    if (from_line(middle, a, b) < 0.4 * side.beyond || far.turn * side.turn <= 0.0) continue;
    const double bend = flat[at(far.other)] ? 2.0 * far.turn : curvature(far) * side.beyond;
    if (std::abs(bend) > std::abs(most)) most = bend;
  }
  return most;
}

struct Votes {
  int flat = 0, curved = 0;
};

// What the sides of a triangle or quadrangle say about it.
Votes ask_sides(const SurfaceMesh& surface, const std::vector<std::vector<RegionSide>>& sides,
                const std::vector<bool>& flat, int region, double feature_angle) {
  Votes votes;
  for (const RegionSide& side : sides[at(region)]) {
    const double expected = std::abs(curvature(side)) * side.width;
    const bool wide = side.width > kWide * side.beyond;
    if (flat[at(side.other)]) continue;
    const double across = turn_across(surface, side, sides[at(side.other)], flat);
    const double turn = (2.0 * side.turn - across) * (side.turn < 0.0 ? -1.0 : 1.0);
    if (wide || turn > feature_angle || (across != 0.0 && turn < kNoTurn * expected))
      ++votes.flat;
    else if (across != 0.0 && turn >= kAlike * expected)
      ++votes.curved;
  }
  return votes;
}

// Regions connected through smooth sides, flats apart, in which nothing says that it is curved.
void flatten_unproven(const std::vector<std::vector<RegionSide>>& sides,
                      const std::vector<Votes>& votes, std::vector<bool>& flat) {
  std::vector<bool> seen = flat;
  for (std::size_t seed = 0; seed < flat.size(); ++seed) {
    if (seen[seed]) continue;
    std::vector<int> group{static_cast<int>(seed)};
    seen[seed] = true;
    int curved = 0;
    for (std::size_t i = 0; i < group.size(); ++i) {
      curved += votes[at(group[i])].curved;
      for (const RegionSide& side : sides[at(group[i])])
        if (!seen[at(side.other)]) {
          seen[at(side.other)] = true;
          group.push_back(side.other);
        }
    }
    if (curved == 0 || group.size() < 2)
      for (const int region : group) flat[at(region)] = true;
  }
}

}  // namespace

PlanarRegions find_planar_regions(const SurfaceMesh& surface, const Neighbours& neighbours) {
  PlanarRegions regions;
  const std::size_t n = neighbours.size();
  const double tolerance = kInPlane * extent(surface.points);
  std::vector<double> area(n);
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t t = 0; t < n; ++t) area[t] = triangle_area(surface, static_cast<Eigen::Index>(t));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return area[at(a)] > area[at(b)]; });
  regions.of_triangle.assign(n, -1);
  for (const int seed : order) {
    if (regions.of_triangle[at(seed)] >= 0) continue;
    const int region = static_cast<int>(regions.triangles.size());
    const Vector3d normal = triangle_normal(surface, seed), origin = corner(surface, seed, 0);
    const auto in_plane = [&](int t) {
      for (int k = 0; k < 3; ++k)
        if (std::abs(normal.dot(corner(surface, t, k) - origin)) > tolerance) return false;
      return normal.dot(triangle_normal(surface, t)) >= 0.0;
    };
    std::vector<int> group{seed};
    regions.of_triangle[at(seed)] = region;
    for (std::size_t i = 0; i < group.size(); ++i)
      for (const int other : neighbours[at(group[i])]) {
        if (other < 0 || regions.of_triangle[at(other)] >= 0 || !in_plane(other)) continue;
        regions.of_triangle[at(other)] = region;
        group.push_back(other);
      }
    Vector3d sum = Vector3d::Zero();
    for (const int t : group) sum += area[at(t)] * triangle_normal(surface, t);
    regions.normal.push_back(sum.normalized());
    regions.triangles.push_back(std::move(group));
  }
  return regions;
}

void mark_flat_regions(const SurfaceMesh& surface, const Neighbours& neighbours,
                       PlanarRegions& regions, double feature_angle) {
  const auto sides = smooth_sides(surface, neighbours, regions, feature_angle);
  const std::size_t n = regions.triangles.size();
  std::vector<bool> flat(n);
  std::vector<Votes> votes(n);
  for (std::size_t r = 0; r < n; ++r)
    flat[r] = sides[r].empty() ||
              !has_few_corners(surface, neighbours, regions, static_cast<int>(r));
  regions.flat = flat;
  for (std::size_t r = 0; r < n; ++r) {
    if (flat[r]) continue;
    votes[r] = ask_sides(surface, sides, flat, static_cast<int>(r), feature_angle);
    regions.flat[r] = votes[r].flat > 0 && votes[r].curved == 0;
  }
  flatten_unproven(sides, votes, regions.flat);
}

}  // namespace codesign::fem
