#include "fem/surface/surface_features.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "fem/surface/connected_groups.hpp"
#include "fem/surface/edge_key.hpp"

namespace codesign::fem {
namespace {

constexpr double kCornerCosine = 0.7071067811865476;  // lines are cut where they turn by 45°

}  // namespace

Neighbors triangle_neighbors(const Triangles& triangles) {
  struct Side {
    int triangle, edge, uses;
  };
  const auto n = static_cast<std::size_t>(triangles.rows());
  Neighbors neighbors(n, {-1, -1, -1});
  std::unordered_map<std::uint64_t, Side> first;
  first.reserve(2 * n);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint64_t key = edge_key(triangles(t, k), triangles(t, (k + 1) % 3));
      const auto [at, fresh] = first.try_emplace(key, Side{static_cast<int>(t), k, 1});
      if (fresh) continue;
      Side& side = at->second;
      int& there =
          neighbors[static_cast<std::size_t>(side.triangle)][static_cast<std::size_t>(side.edge)];
      if (++side.uses == 2) {
        there = static_cast<int>(t);
        neighbors[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)] = side.triangle;
      } else if (there >= 0) {  // a third triangle: the edge joins nobody
        auto& second = neighbors[static_cast<std::size_t>(there)];
        std::replace(second.begin(), second.end(), side.triangle, -1);
        there = -1;
      }
    }
  return neighbors;
}

Patches find_patches(const SurfaceMesh& surface, double feature_angle) {
  Patches patches;
  patches.neighbors = triangle_neighbors(surface.triangles);
  std::vector<Eigen::Vector3d> normals;
  normals.reserve(patches.neighbors.size());
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t)
    normals.push_back(triangle_normal(surface, t));
  const double cosine = std::cos(feature_angle);
  const auto smooth = [&](std::size_t t, int k) {
    const auto other = static_cast<std::size_t>(patches.neighbors[t][static_cast<std::size_t>(k)]);
    return surface.face[t] == surface.face[other] && normals[t].dot(normals[other]) >= cosine;
  };
  patches.line.assign(normals.size(), {false, false, false});
  for (std::size_t t = 0; t < normals.size(); ++t)
    for (int k = 0; k < 3; ++k)
      patches.line[t][static_cast<std::size_t>(k)] =
          patches.neighbors[t][static_cast<std::size_t>(k)] >= 0 && !smooth(t, k);
  int count = 0;
  std::tie(patches.of_triangle, count) = connected_groups(
      patches.neighbors, [&](std::size_t t, std::size_t k) { return !patches.line[t][k]; });
  std::tie(patches.shell, patches.shells) = connected_groups(patches.neighbors);
  patches.face.assign(static_cast<std::size_t>(count), 0);
  for (std::size_t t = 0; t < patches.of_triangle.size(); ++t)
    patches.face[static_cast<std::size_t>(patches.of_triangle[t])] = surface.face[t];
  return patches;
}

namespace {

struct LineEdge {
  int a, b;
  std::pair<int, int> patches;
};

// Edges that are feature lines, each once.
std::vector<LineEdge> line_edges(const SurfaceMesh& surface, const Patches& patches) {
  std::vector<LineEdge> edges;
  for (std::size_t t = 0; t < patches.neighbors.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int other = patches.neighbors[t][static_cast<std::size_t>(k)];
      if (!patches.line[t][static_cast<std::size_t>(k)] || static_cast<int>(t) > other) continue;
      const int p = patches.of_triangle[t];
      const int q = patches.of_triangle[static_cast<std::size_t>(other)];
      const auto row = static_cast<Eigen::Index>(t);
      edges.push_back(
          {surface.triangles(row, k), surface.triangles(row, (k + 1) % 3), std::minmax(p, q)});
    }
  return edges;
}

}  // namespace

std::vector<FeatureLine> find_feature_lines(const SurfaceMesh& surface, const Patches& patches) {
  const std::vector<LineEdge> edges = line_edges(surface, patches);
  std::map<int, std::vector<int>> edges_at;  // ordered: the same lines in every run
  for (std::size_t e = 0; e < edges.size(); ++e) {
    edges_at[edges[e].a].push_back(static_cast<int>(e));
    edges_at[edges[e].b].push_back(static_cast<int>(e));
  }
  const auto far_end = [&](int e, int p) {
    const LineEdge& edge = edges[static_cast<std::size_t>(e)];
    return edge.a == p ? edge.b : edge.a;
  };
  const auto direction = [&](int e, int p) -> Eigen::RowVector3d {
    return (surface.points.row(far_end(e, p)) - surface.points.row(p)).normalized();
  };
  const auto is_corner = [&](int p) {
    const std::vector<int>& at = edges_at[p];
    return at.size() != 2 ||
           edges[static_cast<std::size_t>(at[0])].patches !=
               edges[static_cast<std::size_t>(at[1])].patches ||
           -direction(at[0], p).dot(direction(at[1], p)) < kCornerCosine;
  };

  std::vector<FeatureLine> lines;
  std::vector<bool> used(edges.size(), false);
  const auto walk = [&](int start, int e) {
    FeatureLine line{{start}, edges[static_cast<std::size_t>(e)].patches, is_corner(start)};
    for (int at = start; !used[static_cast<std::size_t>(e)];) {
      used[static_cast<std::size_t>(e)] = true;
      at = far_end(e, at);
      line.points.push_back(at);
      if (is_corner(at)) break;
      const std::vector<int>& next = edges_at[at];
      e = next[0] == e ? next[1] : next[0];
    }
    lines.push_back(std::move(line));
  };
  for (const auto& [p, at] : edges_at)
    if (is_corner(p))
      for (const int e : at)
        if (!used[static_cast<std::size_t>(e)]) walk(p, e);
  for (std::size_t e = 0; e < edges.size(); ++e)  // closed lines without a corner
    if (!used[e]) walk(edges[e].a, static_cast<int>(e));
  return lines;
}

void label_by_angle(SurfaceMesh& surface, double feature_angle) {
  surface.face.assign(static_cast<std::size_t>(surface.triangles.rows()), 0);
  const Patches patches = find_patches(surface, feature_angle);
  surface.face = patches.of_triangle;
  surface.face_names.assign(patches.face.size(), "");
}

}  // namespace codesign::fem
