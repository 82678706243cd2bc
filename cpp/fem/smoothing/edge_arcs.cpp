#include "fem/smoothing/edge_arcs.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

#include "fem/mesh/tet_neighbors.hpp"
#include "fem/surface/edge_key.hpp"

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

constexpr double kPieceTurn = 0.18;   // rad, of a piece of any arc
constexpr double kLeastTurn = 0.09;   // rad, of a piece of a large arc,
constexpr double kChordError = 3e-4;  // one farther than this part of the extent from its chord
constexpr double kShortest = 1e-3;    // piece, of the extent: the mesher would collapse it
constexpr int kMostHalvings = 5;
constexpr double kNoTurn = 1e-9;     // rad: straight
constexpr double kClearLine = 0.26;  // sine of the angle of two sides whose intersection is clear
constexpr double kOfFeature = 0.75;  // of the feature angle: between arc and chord
constexpr double kLopsided = 0.5;    // of their sum: difference of both ends' angles to the chord
constexpr double kAlike = 0.5;       // smaller over larger curvature of a border's neighboring arcs

std::size_t index(int i) { return static_cast<std::size_t>(i); }

class ArcFinder {
 public:
  ArcFinder(const SurfaceMesh& surface, const SmoothNormals& normals,
            const std::vector<bool>& literal, double feature_angle)
      : surface_(surface),
        normals_(normals),
        literal_(literal),
        most_(kOfFeature * feature_angle),
        extent_(extent(surface.points)),
        neighbors_(triangle_neighbors(surface.triangles)) {
    for (int t = 0; t < std::ssize(neighbors_); ++t)
      for (int k = 0; k < 3; ++k)
        if (is_rim(t, k)) {
          rim_[{region(t), tail(t, k)}].push_back(head(t, k));
          rim_[{region(t), head(t, k)}].push_back(tail(t, k));
        }
  }

  EdgeArcs run() {
    EdgeArcs found;
    found.of_triangle.resize(neighbors_.size());
    std::unordered_map<std::uint64_t, int> arc_of;
    for (int t = 0; t < std::ssize(neighbors_); ++t)
      for (int k = 0; k < 3; ++k) {
        const auto [place, fresh] = arc_of.try_emplace(edge_key(tail(t, k), head(t, k)),
                                                       static_cast<int>(found.arcs.size()));
        if (fresh) found.arcs.push_back(make_arc(t, k));
        found.of_triangle[index(t)][index(k)] = place->second;
      }
    return found;
  }

 private:
  int tail(int t, int k) const { return surface_.triangles(t, k); }
  int head(int t, int k) const { return surface_.triangles(t, (k + 1) % 3); }
  int region(int t) const { return normals_.regions.of_triangle[index(t)]; }
  bool flat(int t) const { return normals_.regions.flat[index(region(t))]; }
  Vector3d point(int p) const { return surface_.points.row(p).transpose(); }

  // Edge of a flat that runs smoothly into a curved face.
  bool is_rim(int t, int k) const {
    const int other = neighbors_[index(t)][index(k)];
    return other >= 0 && !normals_.sharp[index(t)][index(k)] && flat(t) && !flat(other);
  }

  bool is_smooth(int t, int k) const { return !normals_.sharp[index(t)][index(k)] && !flat(t); }

  // Of the normal along an edge; more than that of the edge itself where this is a long diagonal.
  double normal_turn(int t, int k) const {
    const Vector3d& n = normals_.at_corner[index(t)][index(k)];
    const Vector3d& m = normals_.at_corner[index(t)][index((k + 1) % 3)];
    return std::atan2(n.cross(m).norm(), n.dot(m));
  }

  int side_of(int t, int other) const {
    const auto& there = neighbors_[index(other)];
    return static_cast<int>(std::find(there.begin(), there.end(), t) - there.begin());
  }

  EdgeArc make_arc(int t, int k) const {
    const int other = neighbors_[index(t)][index(k)];
    const int a = tail(t, k), b = head(t, k);
    std::optional<std::pair<Vector3d, Vector3d>> tangents;
    if (other >= 0 && !literal_[index(t)] && !literal_[index(other)]) {
      const int j = side_of(t, other);
      if (is_rim(t, k))
        tangents = rim_tangents(region(t), a, b);
      else if (is_rim(other, j))
        tangents = rim_tangents(region(other), a, b);
      else if (!flat(t) || !flat(other))
        tangents = {tangent(t, k, k, other, (j + 1) % 3, b),
                    tangent(t, k, (k + 1) % 3, other, j, b)};
    }
    EdgeArc arc = bend(point(a), point(b), tangents, is_smooth(t, k) ? normal_turn(t, k) : 0.0);
    arc.ends = {a, b};
    if (a > b) {
      std::swap(arc.ends[0], arc.ends[1]);
      std::reverse(arc.control.begin(), arc.control.end());
    }
    return arc;
  }

  // Unit direction of the edge from corner k of triangle t at its corner i, which is corner j of
  // the triangle on the other side; along the chord where there is no normal.
  Vector3d tangent(int t, int k, int i, int other, int j, int head_point) const {
    const Vector3d chord = (point(head_point) - point(tail(t, k))).normalized();
    if (normals_.singular[index(t)][index(i)] || normals_.singular[index(other)][index(j)])
      return chord;
    const Vector3d& n = normals_.at_corner[index(t)][index(i)];
    const Vector3d& m = normals_.at_corner[index(other)][index(j)];
    if (normals_.sharp[index(t)][index(k)]) {
      const Vector3d line = n.cross(m);
      if (line.norm() > kClearLine) return (line.dot(chord) < 0.0 ? -line : line).normalized();
      if (n.dot(m) < 0.0) return chord;
    }
    const Vector3d normal = (n + m).normalized();
    return (chord - chord.dot(normal) * normal).normalized();
  }

  // Tangents of the circles through neighboring points of the border of a flat.
  std::optional<std::pair<Vector3d, Vector3d>> rim_tangents(int flat_region, int a, int b) const {
    const auto before = beyond(flat_region, a, b), after = beyond(flat_region, b, a);
    if (!before || !after) return {};
    const Vector3d chord = point(b) - point(a);
    const auto circle = [](const Vector3d& in, const Vector3d& out) -> Vector3d {
      return (in / in.squaredNorm() + out / out.squaredNorm()).normalized();
    };
    const Vector3d u = circle(point(a) - point(*before), chord);
    const Vector3d v = circle(chord, point(*after) - point(b));
    const double first = chord.cross(u).dot(v.cross(chord));
    const double ratio = chord.cross(u).norm() / chord.cross(v).norm();
    if (!(first > 0.0) || ratio < kAlike || ratio > 1.0 / kAlike) return {};
    return {{u, v}};
  }

  // The point before a on the border on which b follows, if the border does not branch.
  std::optional<int> beyond(int flat_region, int a, int b) const {
    const auto found = rim_.find({flat_region, a});
    if (found == rim_.end() || found->second.size() != 2) return {};
    return found->second[0] == b ? found->second[1] : found->second[0];
  }

  EdgeArc bend(const Vector3d& a, const Vector3d& b,
               const std::optional<std::pair<Vector3d, Vector3d>>& tangents,
               double least_turn) const {
    EdgeArc arc{{}, {a, a + (b - a) / 3.0, b + (a - b) / 3.0, b}, 0};
    if (!tangents) return arc;
    const auto& [u, v] = *tangents;
    const double length = (b - a).norm();
    const Vector3d chord = (b - a) / length;
    const double cosine_u = u.dot(chord), cosine_v = v.dot(chord);
    const double least = std::cos(most_);
    if (!(cosine_u >= least) || !(cosine_v >= least)) return arc;
    // Both ends of an arc leave the chord to the same side, by the same angle.
    const Vector3d out = u - cosine_u * chord, in = v - cosine_v * chord;
    const double sum = out.norm() + in.norm();
    if (sum < kNoTurn || (out + in).norm() > kLopsided * sum) return arc;
    arc.control[1] = a + 2.0 * length / (3.0 * (1.0 + cosine_u)) * u;
    arc.control[2] = b - 2.0 * length / (3.0 * (1.0 + cosine_v)) * v;
    double turn = std::max(least_turn, std::atan2(u.cross(v).norm(), u.dot(v)));
    for (double piece = length; arc.halvings < kMostHalvings && too_coarse(turn, piece, extent_);
         piece *= 0.5, turn *= 0.5)
      ++arc.halvings;
    return arc;
  }

  const SurfaceMesh& surface_;
  const SmoothNormals& normals_;
  const std::vector<bool>& literal_;
  double most_;    // rad, between arc and chord
  double extent_;  // m
  Neighbors neighbors_;
  std::map<std::pair<int, int>, std::vector<int>> rim_;  // (flat, point) -> next points
};

}  // namespace

Vector3d EdgeArc::at(double x) const {
  const double y = 1.0 - x;
  return y * y * y * control[0] + 3.0 * x * y * (y * control[1] + x * control[2]) +
         x * x * x * control[3];
}

bool too_coarse(double turn, double length, double extent) {
  return length > 2.0 * kShortest * extent &&
         (turn > kPieceTurn || (turn > kLeastTurn && turn * length / 8.0 > kChordError * extent));
}

EdgeArcs find_edge_arcs(const SurfaceMesh& surface, const SmoothNormals& normals,
                        const std::vector<bool>& literal, double feature_angle) {
  return ArcFinder(surface, normals, literal, feature_angle).run();
}

}  // namespace codesign::fem
