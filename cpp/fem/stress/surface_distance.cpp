#include "fem/stress/surface_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/surface/distance.hpp"

namespace codesign::fem {

namespace {

Eigen::Vector3d node(const TetMesh& mesh, int triangle, int k) {
  return mesh.nodes.row(mesh.boundary(triangle, k)).transpose();
}

}  // namespace

void SurfaceDistance::add(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c, double reach) {
  Piece piece{a, b, c, (a + b + c) / 3.0, 0.0, reach};
  for (const Eigen::Vector3d& x : {a, b, c}) {
    piece.radius = std::max(piece.radius, (x - piece.center).norm());
  }
  max_extent_ = std::max(max_extent_, piece.radius + reach);
  pieces_.push_back(piece);
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

void SurfaceDistance::sort_pieces() {
  Eigen::AlignedBox3d box;
  for (const Piece& p : pieces_) box.extend(p.center);
  if (!pieces_.empty()) box.sizes().maxCoeff(&axis_);
  std::sort(pieces_.begin(), pieces_.end(),
            [this](const Piece& p, const Piece& q) { return p.center[axis_] < q.center[axis_]; });
}

SurfaceDistance::SurfaceDistance(const TetMesh& mesh, const std::vector<int>& triangles,
                                 double reach) {
  for (const int t : triangles) add_triangle(mesh, t, reach);
  sort_pieces();
}

bool SurfaceDistance::within(const Eigen::Vector3d& point, double more) const {
  const double span = max_extent_ + more;
  const auto first =
      std::lower_bound(pieces_.begin(), pieces_.end(), point[axis_] - span,
                       [this](const Piece& piece, double x) { return piece.center[axis_] < x; });
  for (auto p = first; p != pieces_.end() && p->center[axis_] <= point[axis_] + span; ++p) {
    const double reach = p->reach + more, far = reach + p->radius;
    if (reach < 0 || (p->center - point).squaredNorm() > far * far) continue;
    if (squared_distance_to_triangle(point, p->a, p->b, p->c) <= reach * reach) return true;
  }
  return false;
}

double SurfaceDistance::distance(const Eigen::Vector3d& point) const {
  double square = std::numeric_limits<double>::infinity();
  for (const Piece& p : pieces_) {
    square = std::min(square, squared_distance_to_triangle(point, p.a, p.b, p.c));
  }
  return std::sqrt(square);
}

double SurfaceDistance::smallest_reach() const {
  double reach = pieces_.empty() ? 0.0 : std::numeric_limits<double>::infinity();
  for (const Piece& p : pieces_) reach = std::min(reach, p.reach);
  return reach;
}

double SurfaceDistance::largest_reach() const {
  double reach = 0.0;
  for (const Piece& p : pieces_) reach = std::max(reach, p.reach);
  return reach;
}

}  // namespace codesign::fem
