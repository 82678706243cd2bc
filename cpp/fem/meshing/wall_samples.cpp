#include "fem/meshing/wall_samples.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

constexpr double kFinest = 1.0 / 20.0;   // distance of samples, relative to the limit
constexpr double kMostSamples = 1e5;     // of the whole surface, about
constexpr double kFacing = 0.5;          // cosine from which faces are opposite to each other
constexpr double kParallel = 0.99985;    // of faces with a common edge that form a wall: 1 degree
constexpr double kRoundParallel = 0.94;  // of one smooth face: 20 degrees
constexpr double kOnLine = 1e-6;         // relative to the limit
constexpr double kSpacing = 0.5;         // of samples, relative to the wall
constexpr double kLineStep = 0.5;        // of the distance found

class Sampler {
 public:
  Sampler(const PreparedSurface& prepared, double limit)
      : prepared_(prepared),
        surface_(prepared.surface),
        patches_(prepared.patches),
        oracle_(prepared.oracle),
        limit_(limit) {
    double area = 0.0;
    for (Eigen::Index t = 0; t < surface_.triangles.rows(); ++t) area += triangle_area(surface_, t);
    finest_ = std::max(kFinest * limit, std::sqrt(area / kMostSamples));
    for (const FeatureLine& line : prepared.lines) meeting_.insert(line.patches);
    for (Eigen::Index t = 0; t < surface_.triangles.rows(); ++t)
      for (int k = 0; k < 3; ++k)
        patches_at_[surface_.triangles(t, k)].insert(patch_of(static_cast<int>(t)));
  }

  void sample_triangle(int t) {
    if (triangle_normal(surface_, t).isZero()) return;
    std::vector<Piece> pieces{
        {corner(surface_, t, 0), corner(surface_, t, 1), corner(surface_, t, 2)}};
    while (!pieces.empty()) {
      const Piece piece = pieces.back();
      pieces.pop_back();
      const double longest = longest_edge(piece).first, reach = std::max(limit_, finest_);
      if (longest <= reach)
        sample_piece(t, piece);
      else if (2.0 * area(piece) < reach * longest)
        cut_across(piece, static_cast<int>(std::ceil(longest / reach)), pieces);
      else
        halve(piece, pieces);
    }
  }

  void sample_line(const FeatureLine& line) {
    std::set<int> own{line.patches.first, line.patches.second};
    if (line.starts_at_corner)
      for (const int end : {line.points.front(), line.points.back()})
        own.insert(patches_at_[end].begin(), patches_at_[end].end());
    const auto foreign = [&](int patch) { return own.count(patch) == 0; };
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
      const Vector3d a = surface_.points.row(line.points[i]).transpose();
      const Vector3d b = surface_.points.row(line.points[i + 1]).transpose();
      const double length = (b - a).norm();
      for (double s = 0.0; s < length;) {
        const Vector3d p = a + s / length * (b - a);
        const auto found = oracle_.nearest_where(p, limit_, foreign);
        const double distance = found ? (found->point - p).norm() : limit_;
        if (found && !on_feature_line(prepared_, *found, kOnLine * limit_))
          samples_.push_back({p, distance, 0.0});
        s += std::max(kLineStep * distance, finest_);
      }
    }
  }

  std::vector<WallSample> take() { return std::move(samples_); }

 private:
  using Piece = std::array<Vector3d, 3>;  // of a triangle

  // Halves a small piece of triangle t until it is as fine as the wall and the gap at it ask for.
  void sample_piece(int t, const Piece& whole_piece) {
    const Vector3d normal = triangle_normal(surface_, t);
    const std::vector<int> nearby = opposite(whole_piece, normal);
    std::vector<Piece> pieces{whole_piece};
    while (!pieces.empty()) {
      const Piece piece = pieces.back();
      pieces.pop_back();
      const Vector3d center = (piece[0] + piece[1] + piece[2]) / 3.0;
      const double wall = thickness(t, center, -normal, nearby);
      const double gap = thickness(t, center, normal, nearby);
      if (gap < limit_) samples_.push_back({center, gap, 0.0});
      const double spacing = std::max(kSpacing * std::min(wall, gap), finest_);
      const bool whole = longest_edge(piece).first <= spacing;
      if (whole || wall < limit_) samples_.push_back({center, wall, whole ? area(piece) : 0.0});
      if (!whole) halve(piece, pieces);
    }
  }

  // The triangles that walls and gaps at a piece can end at.
  std::vector<int> opposite(const Piece& piece, const Vector3d& normal) const {
    const Vector3d reach = (limit_ * normal.cwiseAbs()).array() + kOnLine * limit_;
    return oracle_.in_box(piece[0].cwiseMin(piece[1]).cwiseMin(piece[2]) - reach,
                          piece[0].cwiseMax(piece[1]).cwiseMax(piece[2]) + reach);
  }

  static void halve(const Piece& piece, std::vector<Piece>& pieces) {
    const std::size_t k = longest_edge(piece).second;
    const Vector3d middle = 0.5 * (piece[k] + piece[(k + 1) % 3]);
    pieces.push_back({piece[k], middle, piece[(k + 2) % 3]});
    pieces.push_back({middle, piece[(k + 1) % 3], piece[(k + 2) % 3]});
  }

  // Cuts a slender piece into as many strips across its longest edge. Halving would leave it as
  // slender as it is: a thousand times the samples on the facets of a long tube.
  static void cut_across(const Piece& piece, int strips, std::vector<Piece>& pieces) {
    const std::size_t k = longest_edge(piece).second;
    const Vector3d &start = piece[k], &end = piece[(k + 1) % 3], &tip = piece[(k + 2) % 3];
    const Vector3d along = end - start;
    const double foot = (tip - start).dot(along) / along.squaredNorm();  // of the tip, in 0 … 1
    const auto low = [&](double s) -> Vector3d { return start + s * along; };
    const auto high = [&](double s) -> Vector3d {
      return s <= foot ? start + s / foot * (tip - start)
                       : end + (1.0 - s) / (1.0 - foot) * (tip - end);
    };
    for (int i = 0; i < strips; ++i) {
      const double from = static_cast<double>(i) / strips, to = (i + 1.0) / strips;
      std::vector<Vector3d> outline{low(from), low(to)};
      if (to < 1.0) outline.push_back(high(to));
      if (from < foot && foot < to) outline.push_back(tip);
      if (from > 0.0) outline.push_back(high(from));
      for (std::size_t j = 2; j < outline.size(); ++j)
        pieces.push_back({outline[0], outline[j - 1], outline[j]});
    }
  }

  static double area(const Piece& piece) {
    return 0.5 * (piece[1] - piece[0]).cross(piece[2] - piece[0]).norm();
  }

  int patch_of(int t) const { return patches_.of_triangle[static_cast<std::size_t>(t)]; }

  static std::pair<double, std::size_t> longest_edge(const Piece& piece) {
    std::pair<double, std::size_t> best{-1.0, 0};
    for (std::size_t k = 0; k < 3; ++k)
      if (const double length = (piece[(k + 1) % 3] - piece[k]).norm(); length > best.first)
        best = {length, k};
    return best;
  }

  // To the opposite side of the wall or gap, one of `nearby`; the limit if there is none.
  double thickness(int t, const Vector3d& p, const Vector3d& direction,
                   const std::vector<int>& nearby) const {
    const auto hit = oracle_.first_hit(p, p + limit_ * direction, t, nearby);
    if (!hit) return limit_;
    const double facing =
        -triangle_normal(surface_, t).dot(triangle_normal(surface_, hit->triangle));
    const int own = patch_of(t), other = patch_of(hit->triangle);
    const bool meet = meeting_.count(std::minmax(own, other)) > 0;
    if (own == other ? facing < kRoundParallel : meet && facing < kParallel) return limit_;
    return (hit->point - p).norm() * (facing > kFacing ? facing : 1.0);
  }

  const PreparedSurface& prepared_;
  const SurfaceMesh& surface_;
  const Patches& patches_;
  const SolidOracle& oracle_;
  double limit_, finest_;
  std::set<std::pair<int, int>> meeting_;    // patches with a common line
  std::map<int, std::set<int>> patches_at_;  // by point
  std::vector<WallSample> samples_;
};

}  // namespace

std::vector<WallSample> find_walls(const PreparedSurface& prepared, double limit) {
  Sampler sampler(prepared, limit);
  for (Eigen::Index t = 0; t < prepared.surface.triangles.rows(); ++t)
    sampler.sample_triangle(static_cast<int>(t));
  for (const FeatureLine& line : prepared.lines) sampler.sample_line(line);
  return sampler.take();
}

}  // namespace codesign::fem
