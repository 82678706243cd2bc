#include "fem/surface/surface_simplify.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "fem/surface/self_intersection.hpp"
#include "fem/surface/solid_oracle.hpp"
#include "fem/surface/surface_features.hpp"
#include "interrupt.hpp"

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

constexpr double kMostTurn = 0.5;  // cosine of the angle by which a triangle may turn

class Collapser {
 public:
  Collapser(SurfaceMesh& surface, double tolerance, double feature_angle, bool test_crossing)
      : surface_(surface),
        tolerance_(tolerance),
        triangles_at_(static_cast<std::size_t>(surface.points.rows())),
        lines_at_(static_cast<std::size_t>(surface.points.rows()), 0),
        moved_(static_cast<std::size_t>(surface.points.rows()), 0.0),
        gone_(static_cast<std::size_t>(surface.triangles.rows()), false),
        triangles_of_face_(surface.face_names.size(), 0) {
    const Patches patches = find_patches(surface, feature_angle);
    for (int t = 0; t < static_cast<int>(surface.triangles.rows()); ++t) {
      const auto row = static_cast<std::size_t>(t);
      ++triangles_of_face_[static_cast<std::size_t>(surface.face[row])];
      for (int k = 0; k < 3; ++k) {
        triangles_at(surface.triangles(t, k)).push_back(t);
        // Seen from both sides, an edge counts once at each end.
        if (patches.line[row][static_cast<std::size_t>(k)])
          ++lines_at_[static_cast<std::size_t>(surface.triangles(t, k))];
      }
    }
    if (test_crossing) original_.emplace(surface, patches.of_triangle);
  }

  SimplifyReport run() {
    SimplifyReport report;
    for (bool again = true; again;) {
      again = false;
      for (const auto& [length, edge] : short_edges()) {
        check_interrupt();
        if (!collapse(edge.first, edge.second)) continue;
        ++report.collapsed;
        again = true;
      }
    }
    for (const double distance : moved_) report.distance = std::max(report.distance, distance);
    if (report.collapsed > 0) compact();
    return report;
  }

 private:
  std::vector<int>& triangles_at(int p) { return triangles_at_[static_cast<std::size_t>(p)]; }
  Vector3d point(int p) const { return surface_.points.row(p).transpose(); }
  double& moved(int p) { return moved_[static_cast<std::size_t>(p)]; }

  // Edges that may be collapsed, shortest first.
  std::vector<std::pair<double, std::pair<int, int>>> short_edges() const {
    std::vector<std::pair<double, std::pair<int, int>>> edges;
    for (Eigen::Index t = 0; t < surface_.triangles.rows(); ++t) {
      if (gone_[static_cast<std::size_t>(t)]) continue;
      for (int k = 0; k < 3; ++k) {
        const int a = surface_.triangles(t, k), b = surface_.triangles(t, (k + 1) % 3);
        if (a > b) continue;  // the neighbor sees it the other way round
        const double length = (point(a) - point(b)).norm();
        if (length <= 2.0 * tolerance_) edges.push_back({length, {a, b}});
      }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
  }

  // Where the two ends may meet, best first: at the more important one, else in the middle.
  std::array<Vector3d, 3> meeting_points(int a, int b) const {
    const auto rank = [&](int p) {
      const int lines = lines_at_[static_cast<std::size_t>(p)];
      return lines == 0 ? 0 : lines == 2 ? 1 : 2;
    };
    const Vector3d middle = 0.5 * (point(a) + point(b));
    if (rank(a) > rank(b)) return {point(a), middle, point(b)};
    if (rank(b) > rank(a)) return {point(b), middle, point(a)};
    return {middle, point(a), point(b)};
  }

  bool collapse(int a, int b) {
    std::vector<int> shared;
    for (const int t : triangles_at(a))
      if (has_corner(t, b)) shared.push_back(t);
    if (shared.size() != 2 || !keeps_topology(a, b, shared) || !keeps_faces(shared)) return false;
    for (const Vector3d& target : meeting_points(a, b)) {
      const double distance =
          std::max(moved(a) + (target - point(a)).norm(), moved(b) + (target - point(b)).norm());
      if (distance > tolerance_ || !keeps_sides(a, b, target) || !keeps_sides(b, a, target))
        continue;
      if (original_ && makes_crossing(a, b, target)) continue;
      surface_.points.row(a) = target.transpose();
      moved(a) = distance;
      merge(a, b, shared);
      return true;
    }
    return false;
  }

  bool has_corner(int t, int p) const { return (surface_.triangles.row(t).array() == p).any(); }

  // The neighbors common to both ends are the two opposite corners of the edge and no others.
  bool keeps_topology(int a, int b, const std::vector<int>& shared) {
    const auto ring = [&](int p) {
      std::vector<int> points;
      for (const int t : triangles_at(p))
        for (int k = 0; k < 3; ++k)
          if (surface_.triangles(t, k) != p) points.push_back(surface_.triangles(t, k));
      std::sort(points.begin(), points.end());
      points.erase(std::unique(points.begin(), points.end()), points.end());
      return points;
    };
    const std::vector<int> ring_a = ring(a), ring_b = ring(b);
    std::vector<int> common;
    std::set_intersection(ring_a.begin(), ring_a.end(), ring_b.begin(), ring_b.end(),
                          std::back_inserter(common));
    return common.size() == shared.size() && ring_a.size() + ring_b.size() > 6;
  }

  bool keeps_faces(const std::vector<int>& shared) const {
    const auto face = [&](int t) { return surface_.face[static_cast<std::size_t>(t)]; };
    return std::all_of(shared.begin(), shared.end(), [&](int t) {
      const auto going =
          std::count_if(shared.begin(), shared.end(), [&](int s) { return face(s) == face(t); });
      return surface_.face_names[static_cast<std::size_t>(face(t))].empty() ||
             triangles_of_face_[static_cast<std::size_t>(face(t))] > static_cast<int>(going);
    });
  }

  // No triangle at p, but those that vanish with q, turns over when p moves. Not even one that is
  // narrower than the tolerance: folded, it would be a wedge between two feature lines.
  bool keeps_sides(int p, int q, const Vector3d& target) {
    for (const int t : triangles_at(p)) {
      if (has_corner(t, q)) continue;
      std::array<Vector3d, 3> before, after;
      for (std::size_t k = 0; k < 3; ++k) {
        const int c = surface_.triangles(t, static_cast<int>(k));
        before[k] = point(c);
        after[k] = c == p ? target : before[k];
      }
      const Vector3d n = (before[1] - before[0]).cross(before[2] - before[0]);
      const Vector3d m = (after[1] - after[0]).cross(after[2] - after[0]);
      if (n.dot(m) < kMostTurn * n.norm() * m.norm()) return false;
    }
    return true;
  }

  // Triangle t as it is, or as it will be once b has been merged into a at the target.
  Facet facet(int t, int a, int b, const Vector3d& target) const {
    Facet facet;
    for (std::size_t k = 0; k < 3; ++k) {
      const int c = surface_.triangles(t, static_cast<int>(k));
      facet.point[k] = c == b ? a : c;
      facet.at[k] = c == a || c == b ? target : point(c);
    }
    return facet;
  }

  // Whether a triangle at a or b would cross another or lose its area. As no corner moves farther
  // than the tolerance, those that may be met have their original boxes within it.
  bool makes_crossing(int a, int b, const Vector3d& target) {
    std::vector<int> moving = triangles_at(a);
    moving.insert(moving.end(), triangles_at(b).begin(), triangles_at(b).end());
    std::erase_if(moving, [&](int t) { return has_corner(t, a) && has_corner(t, b); });
    return std::any_of(moving.begin(), moving.end(), [&](int t) {
      const Facet moved = facet(t, a, b, target);
      if (is_degenerate(moved)) return true;
      const Vector3d margin = Vector3d::Constant(tolerance_);
      const std::vector<int> near =
          original_->in_box(moved.at[0].cwiseMin(moved.at[1]).cwiseMin(moved.at[2]) - margin,
                            moved.at[0].cwiseMax(moved.at[1]).cwiseMax(moved.at[2]) + margin);
      return std::any_of(near.begin(), near.end(), [&](int s) {
        if (s == t || gone_[static_cast<std::size_t>(s)] || (has_corner(s, a) && has_corner(s, b)))
          return false;
        const Facet other = facet(s, a, b, target);
        return !is_degenerate(other) && facets_cross(moved, other);
      });
    });
  }

  void merge(int a, int b, const std::vector<int>& shared) {
    for (const int t : shared) {
      gone_[static_cast<std::size_t>(t)] = true;
      --triangles_of_face_[static_cast<std::size_t>(surface_.face[static_cast<std::size_t>(t)])];
      for (int k = 0; k < 3; ++k) std::erase(triangles_at(surface_.triangles(t, k)), t);
    }
    for (const int t : triangles_at(b))
      for (int k = 0; k < 3; ++k)
        if (surface_.triangles(t, k) == b) surface_.triangles(t, k) = a;
    triangles_at(a).insert(triangles_at(a).end(), triangles_at(b).begin(), triangles_at(b).end());
    triangles_at(b).clear();
    lines_at_[static_cast<std::size_t>(a)] =
        std::max(lines_at_[static_cast<std::size_t>(a)], lines_at_[static_cast<std::size_t>(b)]);
  }

  // Drops what is gone and points that no triangle uses.
  void compact() {
    Eigen::Index kept = 0;
    for (Eigen::Index t = 0; t < surface_.triangles.rows(); ++t) {
      if (gone_[static_cast<std::size_t>(t)]) continue;
      surface_.face[static_cast<std::size_t>(kept)] = surface_.face[static_cast<std::size_t>(t)];
      surface_.triangles.row(kept++) = surface_.triangles.row(t).eval();
    }
    surface_.triangles.conservativeResize(kept, 3);
    surface_.face.resize(static_cast<std::size_t>(kept));
    std::vector<int> fresh(moved_.size(), -1);
    int used = 0;
    for (Eigen::Index p = 0; p < surface_.points.rows(); ++p) {
      if (triangles_at(static_cast<int>(p)).empty()) continue;
      fresh[static_cast<std::size_t>(p)] = used;
      surface_.points.row(used++) = surface_.points.row(p).eval();
    }
    surface_.points.conservativeResize(used, 3);
    for (Eigen::Index t = 0; t < kept; ++t)
      for (int k = 0; k < 3; ++k)
        surface_.triangles(t, k) = fresh[static_cast<std::size_t>(surface_.triangles(t, k))];
  }

  SurfaceMesh& surface_;
  double tolerance_;
  std::vector<std::vector<int>> triangles_at_;
  std::vector<int> lines_at_;  // feature edges at a point: 0 smooth, 2 on a line, else a corner
  std::vector<double> moved_;
  std::vector<bool> gone_;
  std::vector<int> triangles_of_face_;
  std::optional<SolidOracle> original_;  // only if collapses are tested for crossing
};

}  // namespace

SimplifyReport simplify_surface(SurfaceMesh& surface, double tolerance, double feature_angle) {
  if (!(tolerance > 0.0)) return {};
  return Collapser(surface, tolerance, feature_angle, false).run();
}

SimplifyReport simplify_without_crossing(SurfaceMesh& surface, double tolerance,
                                         double feature_angle) {
  const SurfaceMesh original = surface;
  SimplifyReport report = simplify_surface(surface, tolerance, feature_angle);
  if (report.collapsed > 0) {
    if (crossing_triangles(surface, 1).empty()) return report;
    surface = original;
    report = Collapser(surface, tolerance, feature_angle, true).run();
  }
  check_self_intersection(surface);
  return report;
}

}  // namespace codesign::fem
