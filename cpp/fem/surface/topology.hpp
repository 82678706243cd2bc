#pragma once

#include <vector>

#include "fem/surface/surface_features.hpp"
#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// Closed pieces of a triangulated surface, each piece connected through edges.
struct Topology {
  std::vector<int> euler;  // Euler characteristic of each piece, ascending; 2 - 2 · genus
  int open_edges = 0;      // of triangles: edges without partner or with more than one
  int pinched_points = 0;  // points where a piece or two touch without a common edge
  bool is_manifold() const { return open_edges == 0 && pinched_points == 0; }
  bool operator==(const Topology&) const = default;
};
Topology measure_topology(const Triangles& triangles);

// The points and edges that are not manifold: one point index each, an end for edges.
std::vector<int> non_manifold_points(const Triangles& triangles);

// Genus of a piece with this Euler characteristic.
inline int genus_of(int euler) { return (2 - euler) / 2; }

}  // namespace codesign::fem
