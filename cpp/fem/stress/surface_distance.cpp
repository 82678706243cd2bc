#include "fem/stress/surface_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "fem/surface/distance.hpp"

namespace codesign::fem {

namespace {

Eigen::Vector3d node(const TetMesh& mesh, int triangle, int k) {
  return mesh.nodes.row(mesh.boundary(triangle, k)).transpose();
}

}  // namespace

void SurfaceDistance::add(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c, double reach) {
  Ball ball{(a + b + c) / 3.0, 0.0, reach, static_cast<int>(pieces_.size())};
  for (const Eigen::Vector3d& x : {a, b, c}) {
    ball.radius = std::max(ball.radius, (x - ball.center).norm());
  }
  max_extent_ = std::max(max_extent_, ball.radius + reach);
  centers_.extend(ball.center);
  balls_.push_back(ball);
  pieces_.push_back({a, b, c, (b - a).cross(c - a).normalized()});
}

void SurfaceDistance::add_triangle(const TetMesh& mesh, int triangle, double reach) {
  constexpr int kParts[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
  for (const auto& part : kParts) {
    add(node(mesh, triangle, part[0]), node(mesh, triangle, part[1]), node(mesh, triangle, part[2]),
        reach);
  }
}

void SurfaceDistance::add_edge(const TetMesh& mesh, int triangle, int k, double reach) {
  const Eigen::Vector3d a = node(mesh, triangle, k), middle = node(mesh, triangle, 3 + k),
                        b = node(mesh, triangle, (k + 1) % 3);
  add(a, middle, middle, reach);
  add(middle, b, b, reach);
}

Eigen::Array3i SurfaceDistance::cell(const Eigen::Vector3d& point) const {
  const Eigen::Array3d place = ((point - centers_.min()).array() / edge_).floor();
  return place.max(0.0).min((cells_ - 1).cast<double>()).cast<int>();
}

std::size_t SurfaceDistance::number(const Eigen::Array3i& cell) const {
  return static_cast<std::size_t>((cell[2] * cells_[1] + cell[1]) * cells_[0] + cell[0]);
}

void SurfaceDistance::sort_pieces() {
  constexpr double kMostAlong = 64;  // cells an axis
  if (balls_.empty()) return;
  edge_ = std::max(max_extent_, centers_.sizes().maxCoeff() / kMostAlong);
  if (!(edge_ > 0)) edge_ = 1.0;
  cells_ = (centers_.sizes().array() / edge_).cast<int>() + 1;
  first_.assign(static_cast<std::size_t>(cells_.prod()) + 1, 0);
  for (const Ball& ball : balls_) ++first_[number(cell(ball.center)) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<int> next = first_;
  std::vector<Ball> sorted(balls_.size());
  for (const Ball& ball : balls_) {
    sorted[static_cast<std::size_t>(next[number(cell(ball.center))]++)] = ball;
  }
  balls_ = std::move(sorted);
}

SurfaceDistance::SurfaceDistance(const TetMesh& mesh, const std::vector<int>& triangles,
                                 double reach) {
  for (const int t : triangles) add_triangle(mesh, t, reach);
  sort_pieces();
}

bool SurfaceDistance::within(const Eigen::Vector3d& point, double more) const {
  const double span = max_extent_ + more;
  if (balls_.empty() || span < 0 || centers_.squaredExteriorDistance(point) > span * span) {
    return false;
  }
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(span);
  const Eigen::Array3i low = cell(point - reach), high = cell(point + reach);
  for (int z = low[2]; z <= high[2]; ++z) {
    for (int y = low[1]; y <= high[1]; ++y) {
      const int end = first_[number({high[0], y, z}) + 1];
      for (int i = first_[number({low[0], y, z})]; i < end; ++i) {
        if (reaches(balls_[static_cast<std::size_t>(i)], point, more)) return true;
      }
    }
  }
  return false;
}

bool SurfaceDistance::reaches(const Ball& ball, const Eigen::Vector3d& point, double more) const {
  const double reach = ball.reach + more, far = reach + ball.radius;
  if (reach < 0 || (ball.center - point).squaredNorm() > far * far) return false;
  const Piece& p = pieces_[static_cast<std::size_t>(ball.piece)];
  if (std::abs(p.normal.dot(point - p.a)) > reach) return false;
  return squared_distance_to_triangle(point, p.a, p.b, p.c) <= reach * reach;
}

double SurfaceDistance::distance(const Eigen::Vector3d& point) const {
  double square = std::numeric_limits<double>::infinity();
  for (const Piece& p : pieces_) {
    square = std::min(square, squared_distance_to_triangle(point, p.a, p.b, p.c));
  }
  return std::sqrt(square);
}

double SurfaceDistance::smallest_reach() const {
  double reach = balls_.empty() ? 0.0 : std::numeric_limits<double>::infinity();
  for (const Ball& ball : balls_) reach = std::min(reach, ball.reach);
  return reach;
}

double SurfaceDistance::largest_reach() const {
  double reach = 0.0;
  for (const Ball& ball : balls_) reach = std::max(reach, ball.reach);
  return reach;
}

}  // namespace codesign::fem
