#include "fem/stress/local_feature.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/surface/solid_oracle.hpp"

namespace codesign::fem {

namespace {

constexpr double kSmoothBend = 0.5235987755982988;  // 30 degrees, between triangles of one surface

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct FlatBoundary {
  explicit FlatBoundary(const TetMesh& mesh)
      : centroid(mesh.boundary.rows(), 3), normal(mesh.boundary.rows(), 3) {
    for (Eigen::Index t = 0; t < mesh.boundary.rows(); ++t) {
      const Eigen::Vector3d a = mesh.nodes.row(mesh.boundary(t, 0)),
                            b = mesh.nodes.row(mesh.boundary(t, 1)),
                            c = mesh.nodes.row(mesh.boundary(t, 2));
      centroid.row(t) = ((a + b + c) / 3.0).transpose();
      normal.row(t) = (b - a).cross(c - a).normalized().transpose();
    }
  }
  Points centroid, normal;
};

double edge_length(const TetMesh& mesh, int triangle, int k) {
  return (mesh.nodes.row(mesh.boundary(triangle, k)) -
          mesh.nodes.row(mesh.boundary(triangle, (k + 1) % 3)))
      .norm();
}

double area(const TetMesh& mesh, int triangle) {
  const Eigen::Vector3d a = mesh.nodes.row(mesh.boundary(triangle, 0)),
                        b = mesh.nodes.row(mesh.boundary(triangle, 1)),
                        c = mesh.nodes.row(mesh.boundary(triangle, 2));
  return 0.5 * (b - a).cross(c - a).norm();
}

// Thickness behind boundary triangles: the way along the inward normal to the free surface.
class Walls {
 public:
  Walls(const TetMesh& mesh, const FlatBoundary& flat, const std::vector<int>& clamped)
      : flat_(flat),
        size_(extent(mesh.nodes)),
        free_(free_surface(mesh, clamped)),
        oracle_(free_, std::vector<int>(static_cast<std::size_t>(free_.triangles.rows()), 0)) {}

  double behind(int triangle) const {
    const Eigen::Vector3d inward = -flat_.normal.row(triangle).transpose();
    const Eigen::Vector3d start = flat_.centroid.row(triangle).transpose() + 1e-6 * size_ * inward;
    double length = size_;
    // The oracle gives any hit; shortening the segment leads to the first one.
    while (const auto found = oracle_.hit(start, start + length * inward)) {
      const double hit = (found->point - start).norm();
      if (!(hit < length * (1.0 - 1e-9))) break;
      length = hit * (1.0 - 1e-7);
    }
    return length;
  }

 private:
  static SurfaceMesh free_surface(const TetMesh& mesh, const std::vector<int>& clamped) {
    SurfaceMesh surface;
    surface.points = mesh.nodes;
    surface.triangles.resize(mesh.boundary.rows() - static_cast<Eigen::Index>(clamped.size()), 3);
    Eigen::Index row = 0;
    for (int t = 0; t < mesh.boundary.rows(); ++t) {
      if (std::binary_search(clamped.begin(), clamped.end(), t)) continue;
      surface.triangles.row(row++) = mesh.boundary.row(t).head<3>();
    }
    return surface;
  }

  const FlatBoundary& flat_;
  double size_;
  SurfaceMesh free_;
  SolidOracle oracle_;
};

// What limits the size of a feature along the smooth surface beside an edge.
class Surroundings {
 public:
  Surroundings(const FlatBoundary& flat, const Neighbors& neighbors, const Walls& walls,
               double share)
      : flat_(flat),
        neighbors_(neighbors),
        walls_(walls),
        share_(share),
        wall_(neighbors.size(), -1.0),
        seen_(neighbors.size(), -1) {}

  // The smallest, at most `limit` (m), of the wall behind the triangle `start`, the distance to the
  // nearest triangle of its smooth surface whose normal differs by a radian, and what keeps the
  // share of the size off thinner walls farther away.
  double size_at(int start, double limit) {
    constexpr double kTurn = 0.5403023058681398;  // cos(1 rad)
    const double smooth = std::cos(kSmoothBend);
    const Eigen::RowVector3d normal = flat_.normal.row(start), origin = flat_.centroid.row(start);
    limit = std::min(limit, wall(start));
    queue_.assign(1, start);
    seen_[at(start)] = ++stamp_;
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      const int t = queue_[i];
      for (const int other : neighbors_[at(t)]) {
        if (other < 0 || seen_[at(other)] == stamp_) continue;
        if (flat_.normal.row(t).dot(flat_.normal.row(other)) < smooth) continue;
        const double distance = (flat_.centroid.row(other) - origin).norm();
        if (distance >= limit) continue;
        seen_[at(other)] = stamp_;
        if (flat_.normal.row(other).dot(normal) <= kTurn) {
          limit = distance;
          continue;
        }
        queue_.push_back(other);
        if (distance < share_ * limit) {
          limit = std::min(limit, std::max(wall(other), distance / share_));
        }
      }
    }
    return limit;
  }

 private:
  double wall(int t) {
    if (wall_[at(t)] < 0) wall_[at(t)] = walls_.behind(t);
    return wall_[at(t)];
  }

  const FlatBoundary& flat_;
  const Neighbors& neighbors_;
  const Walls& walls_;
  double share_;
  std::vector<double> wall_;  // -1: not yet known
  std::vector<int> seen_, queue_;
  int stamp_ = 0;
};

// 4 A / P of the connected piece of the set that each of its triangles belongs to.
std::vector<double> patch_sizes(const TetMesh& mesh, const Neighbors& neighbors,
                                const std::vector<int>& set,
                                const std::vector<BorderEdge>& border) {
  std::vector<int> piece(neighbors.size(), -1);
  for (const int t : set) piece[at(t)] = -2;
  std::vector<double> areas, perimeters;
  for (const int first : set) {
    if (piece[at(first)] != -2) continue;
    const int number = static_cast<int>(areas.size());
    std::vector<int> queue{first};
    piece[at(first)] = number;
    double sum = 0.0;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      sum += area(mesh, queue[i]);
      for (const int other : neighbors[at(queue[i])]) {
        if (other < 0 || piece[at(other)] != -2) continue;
        piece[at(other)] = number;
        queue.push_back(other);
      }
    }
    areas.push_back(sum);
    perimeters.push_back(0.0);
  }
  for (const BorderEdge& e : border) {
    perimeters[at(piece[at(e.inside)])] += edge_length(mesh, e.inside, e.side);
  }
  std::vector<double> sizes;
  for (const BorderEdge& e : border) {
    const std::size_t p = at(piece[at(e.inside)]);
    sizes.push_back(4.0 * areas[p] / perimeters[p]);
  }
  return sizes;
}

}  // namespace

Neighbors boundary_neighbors(const TetMesh& mesh) {
  return triangle_neighbors(mesh.boundary.leftCols<3>());
}

bool is_sharp_pocket(const TetMesh& mesh, const BorderEdge& edge, double bend) {
  const auto corner = [&](int t, int k) -> Eigen::Vector3d {
    return mesh.nodes.row(mesh.boundary(t, k)).transpose();
  };
  const auto normal = [&](int t) -> Eigen::Vector3d {
    return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).normalized();
  };
  const Eigen::Vector3d n = normal(edge.inside);
  const Eigen::Vector3d away =
      (corner(edge.outside, 0) + corner(edge.outside, 1) + corner(edge.outside, 2)) / 3.0 -
      corner(edge.inside, edge.side);
  return away.dot(n) > 0 && n.dot(normal(edge.outside)) < std::cos(bend);
}

std::vector<BorderEdge> border_edges(const Neighbors& neighbors, const std::vector<int>& set,
                                     const std::vector<int>& ignored) {
  std::vector<BorderEdge> edges;
  for (const int t : set) {
    for (int k = 0; k < 3; ++k) {
      const int other = neighbors[at(t)][at(k)];
      if (other < 0 || std::binary_search(set.begin(), set.end(), other)) continue;
      if (std::binary_search(ignored.begin(), ignored.end(), other)) continue;
      edges.push_back({t, k, other});
    }
  }
  return edges;
}

std::vector<double> local_features(const TetMesh& mesh, const Neighbors& neighbors,
                                   const std::vector<int>& clamped,
                                   const std::vector<BorderEdge>& border, double share) {
  if (border.empty()) return {};
  const FlatBoundary flat(mesh);
  const Walls walls(mesh, flat, clamped);
  Surroundings surroundings(flat, neighbors, walls, share);
  std::vector<double> sizes = patch_sizes(mesh, neighbors, clamped, border);
  for (std::size_t i = 0; i < border.size(); ++i) {
    for (const int t : {border[i].outside, border[i].inside}) {
      sizes[i] = surroundings.size_at(t, sizes[i]);
    }
  }
  return sizes;
}

}  // namespace codesign::fem
