#include "fem/smoothing/patch_splitter.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "fem/smoothing/flat_triangles.hpp"

namespace codesign::fem {
namespace {

using Eigen::Vector3d;
using Weights = Eigen::Vector3i;  // barycentric, of kWhole
using Local = std::array<Weights, 3>;

constexpr int kWhole = 1 << 12;  // divisible by two once for every round of splitting
constexpr int kMostRounds = 9;   // of splitting a triangle
constexpr double kFolded = 0.3;  // cosine between a piece and the normal wanted there

std::size_t index(int i) { return static_cast<std::size_t>(i); }

Vector3d parts(const Weights& weights) { return weights.cast<double>() / kWhole; }

// Point-normal triangle whose edges are given arcs.
struct Patch {
  std::array<Vector3d, 3> corner, normal;
  std::array<std::array<Vector3d, 2>, 3> control;  // of the edge from corner k, nearer end first
  Vector3d middle;

  Vector3d at(const Vector3d& b) const {
    Vector3d p = 6.0 * b[0] * b[1] * b[2] * middle;
    for (int k = 0; k < 3; ++k) {
      const double x = b[k], y = b[(k + 1) % 3];
      p += x * x * x * corner[index(k)] +
           3.0 * x * y * (x * control[index(k)][0] + y * control[index(k)][1]);
    }
    return p;
  }
  Vector3d flat_at(const Vector3d& b) const {
    return b[0] * corner[0] + b[1] * corner[1] + b[2] * corner[2];
  }
  Vector3d normal_at(const Vector3d& b) const {
    return (b[0] * normal[0] + b[1] * normal[1] + b[2] * normal[2]).normalized();
  }
};

class Splitter {
 public:
  Splitter(const SurfaceMesh& surface, const SmoothNormals& normals, const EdgeArcs& arcs)
      : coarse_(surface), normals_(normals), arcs_(arcs), extent_(extent(surface.points)) {
    for (Eigen::Index i = 0; i < surface.points.rows(); ++i)
      points_.push_back(surface.points.row(i).transpose());
    for (const EdgeArc& arc : arcs.arcs) {
      const int pieces = 1 << arc.halvings;
      std::vector<int> line{arc.ends[0]};
      for (int i = 1; i < pieces; ++i) {
        const double x = double(i) / pieces;
        const Vector3d chord = (1.0 - x) * arc.control[0] + x * arc.control[3];
        line.push_back(add(arc.at(x), chord));
      }
      line.push_back(arc.ends[1]);
      lines_.push_back(std::move(line));
    }
  }

  SplitSurface run() {
    std::map<std::pair<int, int>, std::vector<int>> flats;  // plane, face -> triangles
    for (int t = 0; t < coarse_.triangles.rows(); ++t) {
      const int region = normals_.regions.of_triangle[index(t)];
      if (normals_.regions.flat[index(region)])
        flats[{region, coarse_.face[index(t)]}].push_back(t);
      else if (has_arc(t))
        split(t);
      else
        keep(t);
    }
    for (const auto& [key, triangles] : flats) {
      if (std::none_of(triangles.begin(), triangles.end(), [&](int t) { return has_arc(t); }))
        for (const int t : triangles) keep(t);
      else
        retriangulate(key.first, triangles);
    }
    return finish();
  }

 private:
  int add(const Vector3d& p, const Vector3d& before) {
    max_distance_ = std::max(max_distance_, (p - before).norm());
    points_.push_back(p);
    return static_cast<int>(points_.size()) - 1;
  }

  void emit(const std::array<int, 3>& corners, int parent) {
    triangles_.push_back(corners);
    parent_.push_back(parent);
  }

  void keep(int t) {
    emit({coarse_.triangles(t, 0), coarse_.triangles(t, 1), coarse_.triangles(t, 2)}, t);
  }

  const EdgeArc& arc(int t, int k) const {
    return arcs_.arcs[index(arcs_.of_triangle[index(t)][index(k)])];
  }

  bool has_arc(int t) const {
    return arc(t, 0).halvings > 0 || arc(t, 1).halvings > 0 || arc(t, 2).halvings > 0;
  }

  // Points along the edge from corner k of triangle t, both ends included.
  std::vector<int> line(int t, int k) const {
    std::vector<int> points = lines_[index(arcs_.of_triangle[index(t)][index(k)])];
    if (points.front() != coarse_.triangles(t, k)) std::reverse(points.begin(), points.end());
    return points;
  }

  Patch make_patch(int t) const {
    Patch patch;
    Vector3d edges = Vector3d::Zero(), corners = Vector3d::Zero();
    const int region = normals_.regions.of_triangle[index(t)];
    for (int k = 0; k < 3; ++k) {
      const std::size_t i = index(k);
      patch.corner[i] = corner(coarse_, t, k);
      patch.normal[i] = normals_.singular[index(t)][i] ? normals_.regions.normal[index(region)]
                                                       : normals_.at_corner[index(t)][i];
      const EdgeArc& edge = arc(t, k);
      const bool forward = edge.ends[0] == coarse_.triangles(t, k);
      patch.control[i] = {edge.control[forward ? 1 : 2], edge.control[forward ? 2 : 1]};
      edges += (patch.control[i][0] + patch.control[i][1]) / 6.0;
      corners += patch.corner[i] / 3.0;
    }
    patch.middle = edges + 0.5 * (edges - corners);
    return patch;
  }

  void split(int t);
  void retriangulate(int region, const std::vector<int>& triangles);
  SplitSurface finish();

  const SurfaceMesh& coarse_;
  const SmoothNormals& normals_;
  const EdgeArcs& arcs_;
  double extent_;
  std::vector<Vector3d> points_;
  std::vector<std::vector<int>> lines_;  // points of each arc
  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> parent_;
  std::set<int> folded_;
  double max_distance_ = 0.0;
  int curved_ = 0;
};

// Pieces of one coarse triangle by rounds of halving edges that turn too much. Whether an edge is
// halved depends on the edge alone, so that neighbors agree.
class PieceMaker {
 public:
  using Add = std::function<int(const Vector3d& b)>;

  PieceMaker(const Patch& patch, const std::array<std::vector<int>, 3>& lines, double extent,
             Add add)
      : patch_(patch), add_(std::move(add)), extent_(extent) {
    for (int k = 0; k < 3; ++k) {
      const std::vector<int>& points = lines[index(k)];
      step_[index(k)] = kWhole / static_cast<int>(points.size() - 1);
      for (int i = 0; i < std::ssize(points); ++i) {
        Weights b = Weights::Zero();
        b[k] = kWhole - i * step_[index(k)];
        b[(k + 1) % 3] = i * step_[index(k)];
        id_[key(b)] = points[index(i)];
      }
    }
  }

  std::vector<Local> run() {
    const Weights a(kWhole, 0, 0), b(0, kWhole, 0), c(0, 0, kWhole);
    std::vector<Local> now{{a, b, c}}, next;
    for (int round = 0; round < kMostRounds; ++round) {
      next.clear();
      for (const Local& piece : now) split(piece, next);
      if (next.size() == now.size()) break;
      now.swap(next);
    }
    return now;
  }

  int id(const Weights& b) {
    const auto [place, fresh] = id_.try_emplace(key(b), -1);
    if (fresh) place->second = add_(parts(b));
    return place->second;
  }

 private:
  static std::uint64_t key(const Weights& b) {
    return std::uint64_t(b[0]) << 32 | std::uint64_t(b[1]);
  }

  double turn(const Weights& a, const Weights& b) const {
    const Vector3d n = patch_.normal_at(parts(a)), m = patch_.normal_at(parts(b));
    return std::atan2(n.cross(m).norm(), n.dot(m));
  }

  bool is_halved(const Weights& a, const Weights& b) const {
    for (int k = 0; k < 3; ++k)  // on the edge opposite to corner k
      if (a[k] == 0 && b[k] == 0)
        return std::abs(a[(k + 1) % 3] - b[(k + 1) % 3]) > step_[index((k + 1) % 3)];
    const double length = (patch_.at(parts(b)) - patch_.at(parts(a))).norm();
    return too_coarse(turn(a, b), length, extent_);
  }

  void split(const Local& piece, std::vector<Local>& out) const {
    std::array<bool, 3> halved;
    int count = 0;
    for (std::size_t k = 0; k < 3; ++k)
      count += halved[k] = is_halved(piece[k], piece[(k + 1) % 3]);
    // Turned so that the first edge is halved and, of two, the last one too.
    std::size_t s = 0;
    while (count > 0 && count < 3 && !(halved[s] && (count == 1 || halved[(s + 2) % 3]))) ++s;
    const Weights &a = piece[s], &b = piece[(s + 1) % 3], &c = piece[(s + 2) % 3];
    const Weights ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
    if (count == 0) {
      out.push_back(piece);
    } else if (count == 1) {
      out.insert(out.end(), {{a, ab, c}, {ab, b, c}});
    } else if (count == 3) {
      out.insert(out.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    } else {
      out.push_back({a, ab, ca});
      if (turn(ab, c) < turn(b, ca))
        out.insert(out.end(), {{ab, b, c}, {ab, c, ca}});
      else
        out.insert(out.end(), {{ab, b, ca}, {b, c, ca}});
    }
  }

  const Patch& patch_;
  Add add_;
  double extent_;
  std::array<int, 3> step_;  // of the lines, in barycentric parts
  std::unordered_map<std::uint64_t, int> id_;
};

void Splitter::split(int t) {
  const Patch patch = make_patch(t);
  PieceMaker maker(patch, {line(t, 0), line(t, 1), line(t, 2)}, extent_,
                   [&](const Vector3d& b) { return add(patch.at(b), patch.flat_at(b)); });
  ++curved_;
  for (const Local& piece : maker.run()) {
    const std::array<int, 3> ids{maker.id(piece[0]), maker.id(piece[1]), maker.id(piece[2])};
    const Vector3d &a = points_[index(ids[0])], &b = points_[index(ids[1])];
    const Vector3d normal = (b - a).cross(points_[index(ids[2])] - a).normalized();
    const Vector3d wanted =
        patch.normal_at((parts(piece[0]) + parts(piece[1]) + parts(piece[2])) / 3.0);
    if (!(normal.dot(wanted) > kFolded)) folded_.insert(t);
    emit(ids, t);
  }
}

void Splitter::retriangulate(int region, const std::vector<int>& triangles) {
  std::map<std::pair<int, int>, std::vector<int>> lines;  // directed edges
  std::set<int> inside;
  for (const int t : triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = coarse_.triangles(t, k), b = coarse_.triangles(t, (k + 1) % 3);
      inside.insert(a);
      if (lines.erase({b, a}) == 0) lines[{a, b}] = line(t, k);
    }
  std::vector<std::pair<int, int>> outline;
  for (const auto& [ends, points] : lines)
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      outline.emplace_back(points[i], points[i + 1]);
      inside.erase(points[i]);
    }
  const auto found = triangulate_flat(points_, outline, {inside.begin(), inside.end()},
                                      normals_.regions.normal[index(region)]);
  if (found) {
    for (const auto& corners : *found) emit(corners, triangles.front());
  } else {
    folded_.insert(triangles.begin(), triangles.end());
    for (const int t : triangles) keep(t);
  }
}

SplitSurface Splitter::finish() {
  SplitSurface result;
  result.surface.face_names = coarse_.face_names;
  result.surface.points.resize(std::ssize(points_), 3);
  for (std::size_t i = 0; i < points_.size(); ++i)
    result.surface.points.row(static_cast<Eigen::Index>(i)) = points_[i].transpose();
  result.surface.triangles.resize(std::ssize(triangles_), 3);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    result.surface.triangles.row(static_cast<Eigen::Index>(t)) =
        Eigen::Map<const Eigen::RowVector3i>(triangles_[t].data());
    result.surface.face.push_back(coarse_.face[index(parent_[t])]);
  }
  result.parent = std::move(parent_);
  result.max_distance = max_distance_;
  result.curved = curved_;
  result.folded.assign(folded_.begin(), folded_.end());
  return result;
}

}  // namespace

SplitSurface split_patches(const SurfaceMesh& surface, const SmoothNormals& normals,
                           const EdgeArcs& arcs) {
  return Splitter(surface, normals, arcs).run();
}

}  // namespace codesign::fem
