#include "fem/stress/surface_distance.hpp"

#include <algorithm>
#include <map>

#include "fem/surface/distance.hpp"

namespace codesign::fem {

namespace {

Eigen::Vector3d node(const TetMesh& mesh, int triangle, int k) {
  return mesh.nodes.row(mesh.boundary(triangle, k)).transpose();
}

}  // namespace

void SurfaceDistance::add(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c) {
  Piece piece{a, b, c, (a + b + c) / 3.0, 0.0};
  for (const Eigen::Vector3d& x : {a, b, c}) {
    piece.radius = std::max(piece.radius, (x - piece.center).norm());
  }
  max_radius_ = std::max(max_radius_, piece.radius);
  pieces_.push_back(piece);
}

void SurfaceDistance::sort_pieces() {
  std::sort(pieces_.begin(), pieces_.end(),
            [](const Piece& p, const Piece& q) { return p.center[0] < q.center[0]; });
}

SurfaceDistance::SurfaceDistance(const TetMesh& mesh, const std::vector<int>& triangles) {
  constexpr int kParts[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
  for (const int t : triangles) {
    for (const auto& part : kParts) {
      add(node(mesh, t, part[0]), node(mesh, t, part[1]), node(mesh, t, part[2]));
    }
  }
  sort_pieces();
}

SurfaceDistance SurfaceDistance::to_border(const TetMesh& mesh, const std::vector<int>& triangles) {
  std::map<std::pair<int, int>, std::pair<int, int>> edges;  // ends -> uses, middle node
  for (const int t : triangles) {
    for (int k = 0; k < 3; ++k) {
      auto& edge = edges[std::minmax(mesh.boundary(t, k), mesh.boundary(t, (k + 1) % 3))];
      ++edge.first;
      edge.second = mesh.boundary(t, 3 + k);
    }
  }
  SurfaceDistance result;
  for (const auto& [ends, edge] : edges) {
    if (edge.first != 1) continue;
    const Eigen::Vector3d a = mesh.nodes.row(ends.first), b = mesh.nodes.row(ends.second),
                          middle = mesh.nodes.row(edge.second);
    result.add(a, middle, middle);
    result.add(middle, b, b);
  }
  result.sort_pieces();
  return result;
}

bool SurfaceDistance::within(const Eigen::Vector3d& point, double distance) const {
  const double reach = distance + max_radius_;
  const auto first =
      std::lower_bound(pieces_.begin(), pieces_.end(), point[0] - reach,
                       [](const Piece& piece, double x) { return piece.center[0] < x; });
  for (auto p = first; p != pieces_.end() && p->center[0] <= point[0] + reach; ++p) {
    const double far = distance + p->radius;
    if ((p->center - point).squaredNorm() > far * far) continue;
    if (squared_distance_to_triangle(point, p->a, p->b, p->c) <= distance * distance) return true;
  }
  return false;
}

}  // namespace codesign::fem
