#pragma once

#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// What a surface is like; lengths in meters.
struct SurfaceReport {
  double volume, area;       // m³, m²
  double shortest_edge;      // m
  double smallest_height;    // of any triangle, m
  int degenerate_triangles;  // height below 1e-9 of the extent
};

// Measures a closed surface. Throws MeshError, saying what, where and why: empty, larger than
// kMaxTriangles or 10 km, open, edges of more than two triangles, neighbors of opposite
// orientation, inside-out, no volume.
SurfaceReport check_surface(const SurfaceMesh& surface);

}  // namespace codesign::fem
