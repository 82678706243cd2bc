#include "fem/boundary/smooth_patch.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

#include "fem/surface/distance.hpp"
#include "fem/surface/surface_features.hpp"

namespace codesign::fem {

namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kDegree = kPi / 180.0;
constexpr double kPlaneTolerance = 3e-5;  // of the surface's extent, of the corners to the plane
constexpr double kGroupBend = 0.1 * kDegree;  // triangles that bend less lie in one plane
constexpr double kSeedAngle = 20.0 * kDegree;
constexpr double kGain =
    2.7;  // area of a curved shape over that of the plane at the start: three chords
constexpr int kGrowths = 8;
// Angle between a chord and the shape at its centroid over the bend between chords, at most.
constexpr double kChordShare = 0.3;
constexpr double kRing = 1e-4;        // least over largest variance of normals that end on a circle
constexpr double kStripLength = 4.0;  // over the width, of a facet between two generators
constexpr double kGeneratorTurn = 0.03;  // of normals along a generator, sine

std::size_t at(int i) { return static_cast<std::size_t>(i); }

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

class Grower {
 public:
  Grower(const SurfaceMesh& surface, double max_bend)
      : surface_(surface),
        max_bend_(max_bend),
        extent_(extent(surface.points)),
        neighbors_(triangle_neighbors(surface.triangles)),
        normal_(surface.triangles.rows(), 3),
        area_(surface.triangles.rows()) {
    for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
      normal_.row(t) = triangle_normal(surface, t).transpose();
      area_[t] = triangle_area(surface, t);
    }
    set_groups();
  }

  SmoothPatch patch(int start) const {
    const SmoothPatch flat{SurfaceType::plane, plane(start)};
    const double flat_area = area_of(flat.triangles);
    SmoothPatch best = flat;
    const std::vector<int> seed = seeds(start, flat_area);
    improve(start, seed, {fit_cylinder, fit_cone, fit_sphere}, best);
    for (const Eigen::Vector3d& line : generators(start)) {
      if (best.type != SurfaceType::plane) break;
      std::vector<int> strips;  // of a cylinder or cone, without what joins its ends smoothly
      for (const int t : seed) {
        if (std::abs(normal(t).dot(line)) <= kGeneratorTurn) strips.push_back(t);
      }
      improve(start, strips, {fit_cylinder, fit_cone}, best);
    }
    if (best.type != SurfaceType::plane || is_plane(flat.triangles)) return best;
    const int own = group_[at(start)];
    SmoothPatch wild{SurfaceType::free, flood(start, [&](int t) {
                       return group_[at(t)] == own || !stands_out_[at(group_[at(t)])];
                     })};
    return wild.triangles.size() > flat.triangles.size() ? wild : flat;
  }

 private:
  using Fit = Primitive (*)(const FitData&);

  // Replaces the best patch by one on a curved shape through a seed, where that is much larger.
  void improve(int start, const std::vector<int>& seed, std::initializer_list<Fit> fits,
               SmoothPatch& best) const {
    if (groups_of(seed) < 3) return;
    for (const Fit fit : fits) {
      const SmoothPatch curved = grow(start, seed, fit);
      const double needed = best.type == SurfaceType::plane ? kGain : 1.02;
      if (area_of(curved.triangles) >= needed * area_of(best.triangles)) best = curved;
    }
  }

  // Directions of the long sides of the start's plane, if it is a long strip between smooth sides.
  std::vector<Eigen::Vector3d> generators(int start) const {
    const int own = group_[at(start)];
    std::vector<Eigen::Vector3d> sides;
    for (const int t : flood(start, [&](int i) { return group_[at(i)] == own; })) {
      for (int k = 0; k < 3; ++k) {
        const int other = neighbors_[at(t)][at(k)];
        if (!joined(t, other) || group_[at(other)] == own) continue;
        const Eigen::Vector3d side = corner(surface_, t, (k + 1) % 3) - corner(surface_, t, k);
        const double width = group_area_[at(own)] / std::max(side.norm(), 1e-300);
        if (side.norm() >= kStripLength * width) sides.push_back(side.normalized());
      }
    }
    return sides;
  }

  Eigen::Vector3d normal(int t) const { return normal_.row(t).transpose(); }
  Eigen::Vector3d centroid(int t) const {
    return (corner(surface_, t, 0) + corner(surface_, t, 1) + corner(surface_, t, 2)) / 3.0;
  }
  double bend(int a, int b) const { return angle(normal(a), normal(b)); }

  bool joined(int t, int other) const {
    return other >= 0 && surface_.face[at(t)] == surface_.face[at(other)] &&
           bend(t, other) <= max_bend_;
  }

  double area_of(const std::vector<int>& triangles) const {
    double sum = 0.0;
    for (const int t : triangles) sum += area_[t];
    return sum;
  }

  int groups_of(const std::vector<int>& triangles) const {
    std::set<int> groups;
    for (const int t : triangles) groups.insert(group_[at(t)]);
    return static_cast<int>(groups.size());
  }

  // What is connected to start through triangles that `accepted` says yes to; sorted.
  template <class Accepted>
  std::vector<int> flood(int start, Accepted accepted) const {
    if (!accepted(start)) return {};
    std::vector<int> queue{start};
    std::vector<char> seen(neighbors_.size(), 0);
    seen[at(start)] = 1;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for (const int other : neighbors_[at(queue[i])]) {
        if (!joined(queue[i], other) || seen[at(other)] || !accepted(other)) continue;
        seen[at(other)] = 1;
        queue.push_back(other);
      }
    }
    std::sort(queue.begin(), queue.end());
    return queue;
  }

  // Groups of coplanar neighbors; a group stands out as a plane if it is larger than half of the
  // groups that it is smoothly joined to.
  void set_groups() {
    group_.assign(neighbors_.size(), -1);
    std::vector<double> areas;
    for (int first = 0; first < static_cast<int>(neighbors_.size()); ++first) {
      if (group_[at(first)] >= 0) continue;
      const int number = static_cast<int>(areas.size());
      std::vector<int> queue{first};
      group_[at(first)] = number;
      areas.push_back(0.0);
      group_centroid_.push_back(Eigen::Vector3d::Zero());
      for (std::size_t i = 0; i < queue.size(); ++i) {
        areas.back() += area_[queue[i]];
        group_centroid_.back() += area_[queue[i]] * centroid(queue[i]);
        for (const int other : neighbors_[at(queue[i])]) {
          if (!joined(queue[i], other) || group_[at(other)] >= 0) continue;
          if (bend(first, other) > kGroupBend) continue;
          group_[at(other)] = number;
          queue.push_back(other);
        }
      }
    }
    for (std::size_t g = 0; g < areas.size(); ++g) group_centroid_[g] /= std::max(areas[g], 1e-300);
    group_area_ = areas;
    std::vector<std::set<int>> beside(areas.size());
    for (int t = 0; t < static_cast<int>(neighbors_.size()); ++t) {
      for (const int other : neighbors_[at(t)]) {
        if (joined(t, other)) beside[at(group_[at(t)])].insert(group_[at(other)]);
      }
    }
    stands_out_.assign(areas.size(), 0);
    for (std::size_t g = 0; g < areas.size(); ++g) {
      double around = 0.0;
      for (const int other : beside[g])
        around += other == static_cast<int>(g) ? 0.0 : areas[at(other)];
      stands_out_[g] = areas[g] > 0.5 * around;
    }
  }

  // True if the groups of a flat patch stand out together.
  bool is_plane(const std::vector<int>& triangles) const {
    std::set<int> own, beside;
    for (const int t : triangles) own.insert(group_[at(t)]);
    for (const int t : triangles) {
      for (const int other : neighbors_[at(t)]) {
        if (joined(t, other) && !own.count(group_[at(other)])) beside.insert(group_[at(other)]);
      }
    }
    double around = 0.0;
    for (const int g : beside) around += group_area_[at(g)];
    return area_of(triangles) > 0.5 * around;
  }

  bool corners_lie_on(const Primitive& p, int t, double tolerance) const {
    for (int k = 0; k < 3; ++k) {
      if (std::abs(p.distance(corner(surface_, t, k))) > tolerance) return false;
    }
    return true;
  }

  // Whether the plane that a triangle belongs to, a chord, touches the shape at its centroid.
  bool chord_touches(const Primitive& p, int t, double most_angle) const {
    const double turn = angle(normal(t), p.normal(group_centroid_[at(group_[at(t)])]));
    return std::min(turn, kPi - turn) <= most_angle;
  }

  // The triangles in the start's plane; fitted twice, since a sliver hardly tells its plane.
  std::vector<int> plane(int start) const {
    Primitive p;
    p.type = SurfaceType::plane;
    p.point = centroid(start);
    p.axis = normal(start);
    const auto on_plane = [&](int t) {
      return t == start || (corners_lie_on(p, t, kPlaneTolerance * extent_) &&
                            angle(normal(t), p.axis) <= 10.0 * kDegree);
    };
    const std::vector<int> first = flood(start, on_plane);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), middle = sum;
    for (const int t : first) {
      sum += area_[t] * normal(t);
      middle += area_[t] * centroid(t);
    }
    if (!(sum.norm() > 0)) return first;
    p.axis = sum.normalized();
    p.point = middle / area_of(first);
    return flood(start, on_plane);
  }

  // Triangles around the start that turn little; planes much larger than its own are left out.
  std::vector<int> seeds(int start, double flat_area) const {
    const int own = group_[at(start)];
    double smallest = max_bend_;
    for (const int t : flood(start, [&](int i) { return group_[at(i)] == own; })) {
      for (const int other : neighbors_[at(t)]) {
        if (!joined(t, other) || group_[at(other)] == own) continue;
        if (group_area_[at(group_[at(other)])] <= 4.0 * flat_area) {
          smallest = std::min(smallest, bend(t, other));
        }
      }
    }
    const double most = std::max(kSeedAngle, 2.2 * smallest);
    return flood(start, [&](int t) {
      return bend(start, t) <= most && group_area_[at(group_[at(t)])] <= 4.0 * flat_area;
    });
  }

  FitData data_of(const std::vector<int>& triangles) const {
    FitData data;
    std::set<int> corners;
    for (const int t : triangles) {
      for (int k = 0; k < 3; ++k) corners.insert(surface_.triangles(t, k));
      data.centroids.push_back(centroid(t));
      data.normals.push_back(normal(t));
      data.areas.push_back(area_[t]);
    }
    for (const int c : corners) data.points.push_back(surface_.points.row(c).transpose());
    return data;
  }

  double largest_bend(const std::vector<int>& triangles) const {
    double largest = 0.0;
    for (const int t : triangles) {
      for (const int other : neighbors_[at(t)]) {
        if (joined(t, other) && std::binary_search(triangles.begin(), triangles.end(), other)) {
          largest = std::max(largest, bend(t, other));
        }
      }
    }
    return largest;
  }

  // The patch on the shape that the seed determines, grown and fitted in turn. Corners of a file's
  // facets lie on the true face; nodes of a mesh may lie within the sagitta of its chords.
  SmoothPatch grow(int start, std::vector<int> region, Fit fit) const {
    Primitive p;
    for (int i = 0; i < kGrowths; ++i) {
      const FitData data = data_of(region);
      p = fit(data);
      if (p.type == SurfaceType::free) return {};
      double error = 0.0;
      for (const Eigen::Vector3d& x : data.points) error = std::max(error, std::abs(p.distance(x)));
      const double turn = largest_bend(region);
      const double sagitta = p.radius * (1.0 - std::cos(0.5 * turn));
      const double tolerance = std::min(2.0 * error, sagitta) + kPlaneTolerance * extent_;
      if (error > sagitta + kPlaneTolerance * extent_ && i > 2) return {};
      const std::vector<int> next = flood(start, [&](int t) {
        return corners_lie_on(p, t, tolerance) &&
               chord_touches(p, t, kChordShare * turn + 0.5 * kDegree);
      });
      if (next.empty() || groups_of(next) < 3) return {};
      if (next == region) break;
      region = next;
    }
    if (p.type == SurfaceType::sphere && !turns_both_ways(region)) return {};
    return {p.type, region};
  }

  // False for a single ring of facets: it lies on a sphere whatever it is cut from, a torus, say.
  bool turns_both_ways(const std::vector<int>& triangles) const {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const int t : triangles) mean += area_[t] * normal(t) / area_of(triangles);
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (const int t : triangles)
      moments += area_[t] * (normal(t) - mean) * (normal(t) - mean).transpose();
    const Eigen::Vector3d spread =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments, Eigen::EigenvaluesOnly)
            .eigenvalues();
    return spread[0] > kRing * spread[2];
  }

  const SurfaceMesh& surface_;
  double max_bend_, extent_;
  Neighbors neighbors_;
  Points normal_;
  Eigen::VectorXd area_;
  std::vector<int> group_;
  std::vector<double> group_area_;
  std::vector<Eigen::Vector3d> group_centroid_;
  std::vector<char> stands_out_;
};

}  // namespace

int nearest_triangle(const SurfaceMesh& surface, const Eigen::Vector3d& point) {
  int nearest = -1;
  double best = std::numeric_limits<double>::infinity();
  for (int t = 0; t < surface.triangles.rows(); ++t) {
    const double d = squared_distance_to_triangle(point, corner(surface, t, 0),
                                                  corner(surface, t, 1), corner(surface, t, 2));
    if (d < best) {
      best = d;
      nearest = t;
    }
  }
  if (nearest < 0) throw std::invalid_argument("the surface has no triangle near the point");
  return nearest;
}

SmoothPatch smooth_patch(const SurfaceMesh& surface, int start, double max_bend) {
  if (start < 0 || start >= surface.triangles.rows()) {
    throw std::invalid_argument("the surface has no such triangle");
  }
  return Grower(surface, max_bend).patch(start);
}

}  // namespace codesign::fem
