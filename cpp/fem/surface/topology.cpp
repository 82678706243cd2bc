#include "fem/surface/topology.hpp"

#include <algorithm>
#include <cstddef>
#include <unordered_map>

#include "fem/surface/disjoint_sets.hpp"

namespace codesign::fem {
namespace {

// Fans: corners of triangles about one point, joined through the edges they share.
struct Fans {
  DisjointSets corners;
  int open_edges = 0;
};

Fans join_corners(const Triangles& triangles, const Neighbors& neighbors) {
  Fans fans{DisjointSets(3 * neighbors.size())};
  for (std::size_t t = 0; t < neighbors.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const int other = neighbors[t][k];
      fans.open_edges += other < 0;
      if (other < static_cast<int>(t)) continue;
      for (const std::size_t c : {k, (k + 1) % 3}) {
        const int point = triangles(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(c));
        for (std::size_t j = 0; j < 3; ++j)
          if (triangles(other, static_cast<Eigen::Index>(j)) == point)
            fans.corners.join(3 * t + c, 3 * static_cast<std::size_t>(other) + j);
      }
    }
  return fans;
}

// Pieces of the surface, by the first triangle found.
DisjointSets join_triangles(const Neighbors& neighbors) {
  DisjointSets pieces(neighbors.size());
  for (std::size_t t = 0; t < neighbors.size(); ++t)
    for (const int other : neighbors[t])
      if (other >= 0) pieces.join(t, static_cast<std::size_t>(other));
  return pieces;
}

std::size_t count_points(const Triangles& triangles) {
  std::vector<int> points(triangles.data(), triangles.data() + triangles.size());
  std::sort(points.begin(), points.end());
  return static_cast<std::size_t>(std::unique(points.begin(), points.end()) - points.begin());
}

}  // namespace

Topology measure_topology(const Triangles& triangles) {
  const Neighbors neighbors = triangle_neighbors(triangles);
  Fans fans = join_corners(triangles, neighbors);
  DisjointSets pieces = join_triangles(neighbors);
  std::unordered_map<std::size_t, std::size_t> piece_of;  // root triangle -> piece
  std::vector<int> twice;  // 2 · Euler characteristic: a side of a triangle is half an edge
  std::size_t points = 0;
  for (std::size_t t = 0; t < neighbors.size(); ++t) {
    const auto [at, fresh] = piece_of.try_emplace(pieces.find(t), twice.size());
    if (fresh) twice.push_back(0);
    twice[at->second] += 2 - 3;
    for (std::size_t k = 0; k < 3; ++k) {
      if (fans.corners.find(3 * t + k) != 3 * t + k) continue;
      twice[at->second] += 2;
      ++points;
    }
    for (const int other : neighbors[t]) twice[at->second] -= other < 0;
  }
  Topology topology;
  for (const int value : twice) topology.euler.push_back(value / 2);
  std::sort(topology.euler.begin(), topology.euler.end());
  topology.open_edges = fans.open_edges;
  topology.pinched_points = static_cast<int>(points - count_points(triangles));
  return topology;
}

std::vector<int> non_manifold_points(const Triangles& triangles) {
  const Neighbors neighbors = triangle_neighbors(triangles);
  Fans fans = join_corners(triangles, neighbors);
  std::unordered_map<int, std::size_t> fan_of;  // point -> the fan met first
  std::vector<int> found;
  for (std::size_t t = 0; t < neighbors.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const int point = triangles(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(k));
      const std::size_t fan = fans.corners.find(3 * t + k);
      const auto [at, fresh] = fan_of.try_emplace(point, fan);
      if (at->second != fan || neighbors[t][k] < 0) found.push_back(point);
    }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace codesign::fem
