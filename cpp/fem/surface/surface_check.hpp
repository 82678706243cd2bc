#pragma once

#include <utility>
#include <vector>

#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// What a surface is like; lengths in metres.
struct SurfaceReport {
  double volume, area;       // m³, m²
  double shortest_edge;      // m
  double smallest_height;    // of any triangle, m
  int degenerate_triangles;  // height below 1e-9 of the extent
};

// Measures a closed surface. Throws MeshError, saying what, where and why: empty, larger than
// kMaxTriangles or 10 km, open, edges of more than two triangles, neighbours of opposite
// orientation, inside-out, no volume.
SurfaceReport check_surface(const SurfaceMesh& surface);

// Up to `most` pairs of triangles that cross each other; those that share a corner or an edge may
// touch there. Exact predicates. Throws MeshError if the surface touches itself in a point.
std::vector<std::pair<int, int>> crossing_triangles(const SurfaceMesh& surface, int most);

// Throws MeshError if two triangles cross each other, with a place; triangles that share a corner
// or an edge may touch there. Exact predicates.
void check_self_intersection(const SurfaceMesh& surface);

}  // namespace codesign::fem
