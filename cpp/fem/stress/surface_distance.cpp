#include "fem/stress/surface_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

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

int SurfaceDistance::cell(const Eigen::Vector3d& point, Eigen::Index axis) const {
  const double place = std::floor((point[axis] - centers_.min()[axis]) / edge_);
  const int last = cells_[static_cast<std::size_t>(axis)] - 1;
  return static_cast<int>(std::clamp(place, 0.0, static_cast<double>(last)));
}

void SurfaceDistance::sort_pieces() {
  constexpr double kMostAlong = 64;  // cells an axis
  if (balls_.empty()) return;
  edge_ = std::max(max_extent_, centers_.sizes().maxCoeff() / kMostAlong);
  if (!(edge_ > 0)) edge_ = 1.0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    cells_[static_cast<std::size_t>(axis)] = static_cast<int>(centers_.sizes()[axis] / edge_) + 1;
  }
  const auto place = [this](const Ball& ball) {
    return (cell(ball.center, 2) * cells_[1] + cell(ball.center, 1)) * cells_[0] +
           cell(ball.center, 0);
  };
  std::sort(balls_.begin(), balls_.end(),
            [&](const Ball& p, const Ball& q) { return place(p) < place(q); });
  first_.assign(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]) + 1, 0);
  for (const Ball& ball : balls_) ++first_[static_cast<std::size_t>(place(ball)) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
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
  const Eigen::Vector3d low = point.array() - span, high = point.array() + span;
  for (int z = cell(low, 2); z <= cell(high, 2); ++z) {
    for (int y = cell(low, 1); y <= cell(high, 1); ++y) {
      const int row = (z * cells_[1] + y) * cells_[0];
      const int first = first_[static_cast<std::size_t>(row + cell(low, 0))];
      const int end = first_[static_cast<std::size_t>(row + cell(high, 0)) + 1];
      for (int i = first; i < end; ++i) {
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
