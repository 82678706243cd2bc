#include "fem/surface/cap_flips.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "fem/surface/surface_features.hpp"

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

constexpr double kMostTurn = 0.5;  // cosine of the angle by which a triangle may turn
constexpr double kFlat = 0.1;      // of the longest edge: a higher triangle is no cap
constexpr int kRounds = 20;        // a cap may become another one, beyond the next edge

Vector3d normal(const SurfaceMesh& surface, int t) {
  const Vector3d a = corner(surface, t, 0);
  return (corner(surface, t, 1) - a).cross(corner(surface, t, 2) - a);
}

int longest_edge(const SurfaceMesh& surface, int t) {
  int longest = 0;
  double most = -1.0;
  for (int k = 0; k < 3; ++k) {
    const double length = (corner(surface, t, (k + 1) % 3) - corner(surface, t, k)).squaredNorm();
    if (length > most) {
      most = length;
      longest = k;
    }
  }
  return longest;
}

// The corner of t that is not on its edge from corner k.
int opposite(const SurfaceMesh& surface, int t, int k) { return surface.triangles(t, (k + 2) % 3); }

class CapFlipper {
 public:
  CapFlipper(SurfaceMesh& surface, double tolerance, double feature_angle)
      : surface_(surface), tolerance_(tolerance), feature_angle_(feature_angle) {}

  double run() {
    double highest = 0.0;
    for (int round = 0; round < kRounds; ++round) {
      const double height = flip_all();
      if (height == 0.0) break;
      highest = std::max(highest, height);
    }
    return highest;
  }

 private:
  // Caps that share no triangle, each at the line structure of the surface as it is now.
  double flip_all() {
    const Patches patches = find_patches(surface_, feature_angle_);
    std::vector<bool> touched(static_cast<std::size_t>(surface_.triangles.rows()), false);
    double highest = 0.0;
    for (int t = 0; t < static_cast<int>(surface_.triangles.rows()); ++t) {
      const int k = longest_edge(surface_, t);
      const double height = cap_height(t, k);
      if (!(height < tolerance_ && height < kFlat * longest(t, k)) || !is_fold(patches, t))
        continue;
      const int s = patches.neighbors[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)];
      if (s < 0 || touched[static_cast<std::size_t>(s)] || touched[static_cast<std::size_t>(t)])
        continue;
      if (!flip(t, k, s)) continue;
      touched[static_cast<std::size_t>(s)] = touched[static_cast<std::size_t>(t)] = true;
      highest = std::max(highest, height);
    }
    return highest;
  }

  double longest(int t, int k) const {
    return (corner(surface_, t, (k + 1) % 3) - corner(surface_, t, k)).norm();
  }
  double cap_height(int t, int k) const { return normal(surface_, t).norm() / longest(t, k); }

  static bool is_fold(const Patches& patches, int t) {
    const auto& line = patches.line[static_cast<std::size_t>(t)];
    return line[0] && line[1] && line[2];
  }

  // Turns the edge between t and s, which becomes the one from the tip of the cap to the corner
  // beyond, unless a triangle would turn over, the edge exists, or a named face ends with t.
  bool flip(int t, int k, int s) {
    const int a = surface_.triangles(t, k), b = surface_.triangles(t, (k + 1) % 3);
    const int tip = opposite(surface_, t, k);
    int beyond = 0;
    for (int i = 0; i < 3; ++i)
      if (surface_.triangles(s, i) != a && surface_.triangles(s, i) != b)
        beyond = surface_.triangles(s, i);
    if (has_edge(tip, beyond) || ends_face(t, s)) return false;
    const Eigen::RowVector3i cap = surface_.triangles.row(t), other = surface_.triangles.row(s);
    const Vector3d before = normal(surface_, s);
    surface_.triangles.row(t) << tip, a, beyond;
    surface_.triangles.row(s) << beyond, b, tip;
    for (const int fresh : {t, s}) {
      const Vector3d now = normal(surface_, fresh);
      if (now.dot(before) > kMostTurn * now.norm() * before.norm()) continue;
      surface_.triangles.row(t) = cap;
      surface_.triangles.row(s) = other;
      return false;
    }
    surface_.face[static_cast<std::size_t>(t)] = surface_.face[static_cast<std::size_t>(s)];
    return true;
  }

  bool has_edge(int p, int q) const {
    for (Eigen::Index t = 0; t < surface_.triangles.rows(); ++t) {
      const auto row = surface_.triangles.row(t).array();
      if ((row == p).any() && (row == q).any()) return true;
    }
    return false;
  }

  bool ends_face(int t, int s) const {
    const int face = surface_.face[static_cast<std::size_t>(t)];
    return face != surface_.face[static_cast<std::size_t>(s)] &&
           !surface_.face_names[static_cast<std::size_t>(face)].empty() &&
           std::count(surface_.face.begin(), surface_.face.end(), face) == 1;
  }

  SurfaceMesh& surface_;
  double tolerance_, feature_angle_;
};

}  // namespace

double flip_caps(SurfaceMesh& surface, double tolerance, double feature_angle) {
  return tolerance > 0.0 ? CapFlipper(surface, tolerance, feature_angle).run() : 0.0;
}

}  // namespace codesign::fem
