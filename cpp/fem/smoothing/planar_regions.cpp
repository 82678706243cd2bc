#include "fem/smoothing/planar_regions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

constexpr double kInPlane = 2e-6;   // of the extent: rounding of coordinates in a file
constexpr double kNoCorner = 0.03;  // rad, turn of an outline that is no corner
constexpr double kOpposite = 0.2;   // of the width: distance of an opposite side
constexpr double kWide = 2.5;       // times as wide as its neighbor: hardly a chord of the same arc
constexpr double kMisfit = 0.25;    // of the turns that explain a bend
constexpr double kMisfitAngle = 0.02;  // rad
constexpr std::size_t kSample = 64;    // triangles of a region that are measured
constexpr int kPasses = 4;
constexpr int kDepth = 2;           // regions beyond an edge that are asked for their turn
constexpr double kTie = 0.05;       // of those turns: two arcs are likelier than one and a flat
constexpr double kStraight = 0.01;  // rad: no turn
constexpr double kNever = 1e9;      // rad

// A border edge of a planar region where the surface goes on smoothly.
struct RegionSide {
  int region, from, to;  // points, counter-clockwise
  double turn;           // of the normal to the region across, rad; negative where concave
  double width;          // of the region, measured from the edge, m
  int twin;              // the same edge seen from the other region
  bool curved;           // the region is a chord of a surface that is curved across the edge
};

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Vector3d point(const SurfaceMesh& surface, int p) { return surface.points.row(p).transpose(); }

// Distance of p from the line through a and b. [m]
double from_line(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = (b - a).normalized();
  return (p - a - (p - a).dot(along) * along).norm();
}

// Width of a region measured from a line through a and b, from some of many triangles. [m]
double width_from(const SurfaceMesh& surface, const std::vector<int>& triangles, const Vector3d& a,
                  const Vector3d& b) {
  double width = 0.0;
  for (std::size_t i = 0; i < triangles.size(); i += 1 + triangles.size() / kSample)
    for (int k = 0; k < 3; ++k)
      width = std::max(width, from_line(corner(surface, triangles[i], k), a, b));
  return width;
}

// The next point of a region's outline after each; empty if the outline meets itself.
std::map<int, int> outline_of(const SurfaceMesh& surface, const Neighbors& neighbors,
                              const PlanarRegions& regions, int region) {
  std::map<int, int> next;
  for (const int t : regions.triangles[at(region)])
    for (int k = 0; k < 3; ++k) {
      const int other = neighbors[at(t)][at(k)];
      if (other >= 0 && regions.of_triangle[at(other)] == region) continue;
      if (!next.emplace(surface.triangles(t, k), surface.triangles(t, (k + 1) % 3)).second)
        return {};
    }
  return next;
}

// Corners of a convex outline, points on its sides not counted; 0 if it is not convex or has holes.
int count_corners(const SurfaceMesh& surface, const std::map<int, int>& next,
                  const Vector3d& normal) {
  if (next.empty()) return 0;
  int corners = 0;
  std::size_t steps = 0;
  int p = next.begin()->first;
  do {
    const int q = next.at(p), r = next.at(q);
    const Vector3d in = (point(surface, q) - point(surface, p)).normalized();
    const Vector3d out = (point(surface, r) - point(surface, q)).normalized();
    const double turn = std::atan2(in.cross(out).dot(normal), in.dot(out));
    if (turn < -kNoCorner) return 0;
    if (turn > kNoCorner) ++corners;
    p = q;
  } while (++steps < next.size() && p != next.begin()->first);
  return steps == next.size() ? std::max(corners, 3) : 0;  // 3 in a needle too
}

// Decides which regions are curved, and across which of their sides.
class ChordFinder {
 public:
  ChordFinder(const SurfaceMesh& surface, const Neighbors& neighbors, PlanarRegions& regions,
              double feature_angle)
      : surface_(surface), regions_(regions), sides_of_(regions.triangles.size()) {
    const int n = static_cast<int>(regions.triangles.size());
    find_sides(neighbors, feature_angle);
    for (int r = 0; r < n; ++r) {
      outline_.push_back(outline_of(surface, neighbors, regions, r));
      corners_.push_back(count_corners(surface, outline_.back(), regions.normal[at(r)]));
      regions.flat.push_back(sides_of_[at(r)].empty() ||
                             (corners_.back() != 3 && corners_.back() != 4));
    }
  }

  void run() {
    for (pass_ = 0; pass_ < kPasses; ++pass_) {
      std::vector<bool> curved;
      for (const RegionSide& side : sides_) curved.push_back(is_curved_across(side));
      for (std::size_t i = 0; i < sides_.size(); ++i) sides_[i].curved = curved[i];
      for (std::size_t r = 0; r < sides_of_.size(); ++r)
        regions_.flat[r] = regions_.flat[r] || !is_curved(static_cast<int>(r)) ||
                           has_point_on_chord(static_cast<int>(r));
    }
    flatten_single();
    for (int r = 0; r < std::ssize(sides_of_); ++r)
      if (!regions_.flat[at(r)] && corners_[at(r)] == 4) add_straight(r);
  }

 private:
  const RegionSide& twin(const RegionSide& side) const { return sides_[at(side.twin)]; }
  bool flat(const RegionSide& side) const { return regions_.flat[at(side.region)]; }
  bool wide(const RegionSide& side) const { return side.width > kWide * twin(side).width; }

  void find_sides(const Neighbors& neighbors, double feature_angle) {
    std::map<std::pair<int, int>, int> directed;
    for (int t = 0; t < std::ssize(neighbors); ++t)
      for (int k = 0; k < 3; ++k) {
        const int other = neighbors[at(t)][at(k)];
        if (other < 0) continue;
        const int r = regions_.of_triangle[at(t)], s = regions_.of_triangle[at(other)];
        const Vector3d &n = regions_.normal[at(r)], &m = regions_.normal[at(s)];
        const double turn = std::atan2(n.cross(m).norm(), n.dot(m));
        if (r == s || turn > feature_angle) continue;
        const int from = surface_.triangles(t, k), to = surface_.triangles(t, (k + 1) % 3);
        const Vector3d a = point(surface_, from), b = point(surface_, to);
        const bool convex = n.cross(m).dot(b - a) > 0.0;
        directed[{from, to}] = static_cast<int>(sides_.size());
        sides_of_[at(r)].push_back(static_cast<int>(sides_.size()));
        sides_.push_back({r, from, to, convex ? turn : -turn,
                          width_from(surface_, regions_.triangles[at(r)], a, b), -1, false});
      }
    for (RegionSide& side : sides_) side.twin = directed.at({side.to, side.from});
  }

  // Whether the region across a side is not curved there, as far as is known.
  bool runs_straight(const RegionSide& side) const {
    return flat(side) || (pass_ > 0 && !side.curved);
  }

  // What the turn [rad] of a region away from a side may be, from the bends at its opposite sides;
  // nothing is known of triangles.
  std::vector<double> turns_from(const RegionSide& side, int depth) const {
    std::vector<double> turns;
    if (flat(side) || corners_[at(side.region)] == 3) return turns;
    for (const int i : sides_of_[at(side.region)]) {
      const RegionSide& far = sides_[at(i)];
      if (!is_opposite(side.from, side.to, side.width, far) || runs_straight(far)) continue;
      add_turns(far, depth, turns);
    }
    return turns;
  }

  bool has_opposite(const RegionSide& side) const {
    const auto& sides = sides_of_[at(side.region)];
    return std::any_of(sides.begin(), sides.end(), [&](int i) {
      return is_opposite(side.from, side.to, side.width, sides_[at(i)]);
    });
  }

  // The turn that explains the bend at a side if the region across is straight, or has the same
  // curvature, or turns by what is known from beyond it (an inflection, another radius).
  void add_turns(const RegionSide& side, int depth, std::vector<double>& turns) const {
    const RegionSide& there = twin(side);
    const bool straight = runs_straight(there);
    if (straight || !has_opposite(there) || (pass_ == 0 && wide(there)))
      turns.push_back(2.0 * side.turn);
    if (straight) return;
    turns.push_back(2.0 * side.turn / (side.width + there.width) * side.width);
    if (depth == 0) return;
    for (const double other : turns_from(there, depth - 1))
      turns.push_back(2.0 * side.turn - other);
  }

  bool is_curved_across(const RegionSide& side) const {
    const RegionSide& there = twin(side);
    if (flat(side)) return false;
    // Triangles have no opposite sides that would tell.
    if (corners_[at(side.region)] == 3 || corners_[at(there.region)] == 3) return !wide(side);
    const std::vector<double> mine = turns_from(side, kDepth), other = turns_from(there, kDepth);
    const bool can = pass_ > 0 || !wide(side), can_there = pass_ > 0 || !wide(there);
    double most = 0.0, both = kNever, only = kNever, only_there = kNever;
    const auto try_both = [&](double a, double b) {
      if (can && can_there && !flat(there))
        both = std::min(both, std::abs(side.turn - 0.5 * (a + b)));
    };
    for (const double a : mine) {
      most = std::max(most, std::abs(a));
      if (can) only = std::min(only, std::abs(side.turn - 0.5 * a));
      // What is unknown has the curvature of the other one.
      if (other.empty()) try_both(a, a * there.width / side.width);
      for (const double b : other)
        if (std::min(std::abs(a), std::abs(b)) > kStraight) try_both(a, b);
    }
    for (const double b : other) {
      most = std::max(most, std::abs(b));
      if (can_there) only_there = std::min(only_there, std::abs(side.turn - 0.5 * b));
      if (mine.empty()) try_both(b * side.width / there.width, b);
    }
    const double one = std::min(only, only_there);
    if (std::min(both, one) > kMisfit * most + kMisfitAngle) return false;
    return both <= one + kTie * most || only <= only_there;
  }

  bool is_curved(int region) const {
    const auto& sides = sides_of_[at(region)];
    return std::any_of(sides.begin(), sides.end(), [&](int i) { return sides_[at(i)].curved; });
  }

  // A point in the middle of a chord is none of the true surface: the facets were cut after they
  // had been made, as modelers do that know polyhedra only.
  bool has_point_on_chord(int region) const {
    const std::map<int, int>& next = outline_[at(region)];
    std::map<int, bool> curved;  // by the first point of a smooth side
    for (const int i : sides_of_[at(region)]) curved[sides_[at(i)].from] = sides_[at(i)].curved;
    return std::any_of(next.begin(), next.end(), [&](const auto& edge) {
      const auto [p, q] = edge;
      return next.size() > 3 && !is_corner(p, q, next.at(q)) && !curved[p] && !curved[q];
    });
  }

  // A curved region between flats is a chamfer.
  void flatten_single() {
    std::vector<bool>& flat = regions_.flat;
    const std::vector<bool> before = flat;
    for (std::size_t r = 0; r < flat.size(); ++r)
      flat[r] = flat[r] || std::all_of(sides_of_[r].begin(), sides_of_[r].end(), [&](int i) {
                  return before[at(twin(sides_[at(i)]).region)];
                });
  }

  bool is_opposite(int p, int q, double width, const RegionSide& far) const {
    const Vector3d a = point(surface_, p), b = point(surface_, q);
    return from_line(point(surface_, far.from), a, b) > kOpposite * width &&
           from_line(point(surface_, far.to), a, b) > kOpposite * width;
  }

  // The sides across which a quadrangle is not curved, sharp ones too if the opposite one is not.
  void add_straight(int region) {
    const std::map<int, int>& next = outline_[at(region)];
    std::map<int, int> before;
    std::map<int, bool> curved;  // by the first point of a smooth side
    for (const auto& [p, q] : next) before[q] = p;
    for (const int i : sides_of_[at(region)]) curved[sides_[at(i)].from] = sides_[at(i)].curved;
    for (const auto& [p, q] : next) {
      const auto found = curved.find(p);
      if (found == curved.end() ? is_opposite_curved(region, p, q) : found->second) continue;
      const int last = before.at(p), after = next.at(q);
      regions_.straight.push_back(
          {region, p, q, is_corner(last, p, q) ? last : p, is_corner(p, q, after) ? after : q});
    }
  }

  bool is_corner(int p, int q, int r) const {
    const Vector3d in = point(surface_, q) - point(surface_, p);
    const Vector3d out = point(surface_, r) - point(surface_, q);
    return in.cross(out).norm() > kNoCorner * in.norm() * out.norm();
  }

  bool is_opposite_curved(int region, int p, int q) const {
    const double width = width_from(surface_, regions_.triangles[at(region)], point(surface_, p),
                                    point(surface_, q));
    const auto& sides = sides_of_[at(region)];
    return std::any_of(sides.begin(), sides.end(), [&](int i) {
      return sides_[at(i)].curved && is_opposite(p, q, width, sides_[at(i)]);
    });
  }

  const SurfaceMesh& surface_;
  PlanarRegions& regions_;
  std::vector<RegionSide> sides_;
  std::vector<std::vector<int>> sides_of_;  // regions
  std::vector<std::map<int, int>> outline_;
  std::vector<int> corners_;
  int pass_ = 0;
};

}  // namespace

PlanarRegions find_planar_regions(const SurfaceMesh& surface, const Neighbors& neighbors) {
  PlanarRegions regions;
  const std::size_t n = neighbors.size();
  const double tolerance = kInPlane * extent(surface.points);
  std::vector<double> area(n);
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t t = 0; t < n; ++t)
    area[t] = triangle_area(surface, static_cast<Eigen::Index>(t));
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return area[at(a)] > area[at(b)]; });
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
      for (const int other : neighbors[at(group[i])]) {
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

void mark_flat_regions(const SurfaceMesh& surface, const Neighbors& neighbors,
                       PlanarRegions& regions, double feature_angle) {
  ChordFinder(surface, neighbors, regions, feature_angle).run();
}

}  // namespace codesign::fem
