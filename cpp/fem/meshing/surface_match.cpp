#include "fem/meshing/surface_match.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

constexpr double kOffPatch = 0.15;  // of an edge between two patches, relative to its length
constexpr double kAcross = 0.3;     // cosine of a side's normal and that of the surface beside it

Vector3d node(const TetMesh& mesh, int i) { return mesh.nodes.row(i).transpose(); }

// The surface whose triangles are the corner triangles of the boundary.
SurfaceMesh boundary_surface(const TetMesh& mesh) {
  SurfaceMesh surface{mesh.nodes, boundary_triangles(mesh), {}, {""}};
  surface.face.assign(static_cast<std::size_t>(surface.triangles.rows()), 0);
  return surface;
}

// The boundary with its mid-edge nodes: four triangles a side.
SurfaceMesh curved_boundary(const TetMesh& mesh) {
  constexpr int kParts[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
  SurfaceMesh surface{mesh.nodes, Triangles(4 * mesh.boundary.rows(), 3), {}, {""}};
  for (Eigen::Index i = 0; i < mesh.boundary.rows(); ++i)
    for (int part = 0; part < 4; ++part)
      for (int k = 0; k < 3; ++k)
        surface.triangles(4 * i + part, k) = mesh.boundary(i, kParts[part][k]);
  surface.face.assign(static_cast<std::size_t>(surface.triangles.rows()), 0);
  return surface;
}

void add_edges_off_patches(const TetMesh& mesh, const Triangles& triangles,
                           const SolidOracle& oracle, std::vector<Mismatch>& found) {
  const Neighbors neighbors = triangle_neighbors(triangles);
  for (std::size_t t = 0; t < neighbors.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int other = neighbors[t][static_cast<std::size_t>(k)];
      if (other < static_cast<int>(t)) continue;
      const int p = mesh.boundary_face[t], q = mesh.boundary_face[static_cast<std::size_t>(other)];
      if (p == q) continue;
      const auto row = static_cast<Eigen::Index>(t);
      const Vector3d a = node(mesh, triangles(row, k)), b = node(mesh, triangles(row, (k + 1) % 3));
      const Vector3d middle = 0.5 * (a + b);
      const double off = std::max((oracle.nearest(middle, p).point - middle).norm(),
                                  (oracle.nearest(middle, q).point - middle).norm());
      if (off > kOffPatch * (b - a).norm())
        found.push_back(
            {middle, (oracle.nearest(middle, -1).point - middle).norm(), (b - a).norm()});
    }
}

double shortest_edge(const SurfaceMesh& surface, Eigen::Index t) {
  double shortest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
    shortest = std::min(shortest, (corner(surface, t, (k + 1) % 3) - corner(surface, t, k)).norm());
  return shortest;
}

// Edges without exactly two sides, and points where the boundary only touches itself.
void add_non_manifold(const SurfaceMesh& boundary, std::vector<Mismatch>& found) {
  const Triangles& triangles = boundary.triangles;
  std::map<int, double> size_at;  // of points that are not manifold
  for (const int i : non_manifold_points(triangles)) size_at[i] = -1.0;
  const Neighbors neighbors = triangle_neighbors(triangles);
  for (std::size_t t = 0; t < neighbors.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      if (neighbors[t][static_cast<std::size_t>(k)] >= 0) continue;
      const auto row = static_cast<Eigen::Index>(t);
      const double length = (corner(boundary, row, (k + 1) % 3) - corner(boundary, row, k)).norm();
      for (const int i : {triangles(row, k), triangles(row, (k + 1) % 3)})
        size_at[i] = std::max(size_at[i], length);
    }
  std::map<int, double> shortest;  // edge at points without such an edge
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto at = size_at.find(triangles(t, k));
      if (at == size_at.end() || at->second >= 0.0) continue;
      const auto [value, fresh] = shortest.try_emplace(at->first, shortest_edge(boundary, t));
      if (!fresh) value->second = std::min(value->second, shortest_edge(boundary, t));
    }
  for (const auto& [point, size] : size_at) {
    const double length = size >= 0.0 ? size : shortest[point];
    found.push_back({boundary.points.row(point).transpose(), length, length});
  }
}

void add_sides_across(const SurfaceMesh& boundary, const SurfaceMesh& surface,
                      const SolidOracle& oracle, std::vector<Mismatch>& found) {
  for (Eigen::Index t = 0; t < boundary.triangles.rows(); ++t) {
    const Vector3d center =
        (corner(boundary, t, 0) + corner(boundary, t, 1) + corner(boundary, t, 2)) / 3.0;
    const SolidOracle::Hit nearest = oracle.nearest(center, -1);
    if (triangle_normal(boundary, t).dot(triangle_normal(surface, nearest.triangle)) < kAcross)
      found.push_back({center, (nearest.point - center).norm(), shortest_edge(boundary, t)});
  }
}

}  // namespace

Triangles boundary_triangles(const TetMesh& mesh) { return mesh.boundary.leftCols<3>(); }

SurfaceDistance surface_distance(const TetMesh& mesh, const SurfaceMesh& surface,
                                 const SolidOracle& oracle) {
  SurfaceDistance farthest{0.0, oracle.lower()};
  const auto look = [&](const Vector3d& p, const SolidOracle& other) {
    const double distance = (other.nearest(p, -1).point - p).norm();
    if (distance > farthest.distance) farthest = {distance, p};
  };
  const SurfaceMesh boundary = curved_boundary(mesh);
  const SolidOracle back(boundary, boundary.face);
  std::vector<int> nodes(mesh.boundary.data(), mesh.boundary.data() + mesh.boundary.size());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  for (const int i : nodes) look(node(mesh, i), oracle);
  for (Eigen::Index i = 0; i < surface.points.rows(); ++i)
    look(surface.points.row(i).transpose(), back);
  const auto middles = [&](const SurfaceMesh& from, const SolidOracle& to) {
    for (Eigen::Index t = 0; t < from.triangles.rows(); ++t)
      look((corner(from, t, 0) + corner(from, t, 1) + corner(from, t, 2)) / 3.0, to);
  };
  middles(boundary, oracle);
  middles(surface, back);
  return farthest;
}

// Of the wall or gap at a place that the boundary misses, along the normal of the surface.
double thickness_at(const SurfaceMesh& surface, const SolidOracle& oracle,
                    const SurfaceDistance& missed) {
  const SolidOracle::Hit foot = oracle.nearest(missed.place, -1);
  const Vector3d normal = triangle_normal(surface, foot.triangle);
  double thickness = missed.distance;
  for (const double side : {-1.0, 1.0}) {
    const auto hit =
        oracle.first_hit(foot.point, foot.point + side * missed.distance * normal, foot.triangle);
    if (hit) thickness = std::min(thickness, (hit->point - foot.point).norm());
  }
  return thickness;
}

std::vector<Mismatch> find_mismatches(const TetMesh& mesh, const SurfaceMesh& surface,
                                      const SolidOracle& oracle) {
  std::vector<Mismatch> found;
  const SurfaceMesh boundary = boundary_surface(mesh);
  add_non_manifold(boundary, found);
  add_sides_across(boundary, surface, oracle, found);
  if (found.empty()) add_edges_off_patches(mesh, boundary.triangles, oracle, found);
  if (found.empty()) {
    const SurfaceDistance farthest = surface_distance(mesh, surface, oracle);
    found.push_back({farthest.place, farthest.distance, thickness_at(surface, oracle, farthest)});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Mismatch& a, const Mismatch& b) { return a.size > b.size; });
  return found;
}

}  // namespace codesign::fem
