#pragma once

#include <array>
#include <utility>
#include <vector>

#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// neighbors[t][k]: the triangle across the edge from corner k to corner k + 1 of triangle t, or -1
// where the surface is open or the edge is shared by more than two triangles.
using Neighbors = std::vector<std::array<int, 3>>;
Neighbors triangle_neighbors(const Triangles& triangles);

// Pieces of the surface that are bounded by feature lines: edges between different faces, and edges
// where the normal turns by more than `feature_angle` [rad].
struct Patches {
  std::vector<int> of_triangle;  // (m) patch of each triangle, 0-based
  std::vector<int> face;         // (patches) the face each patch belongs to
  std::vector<int> shell;        // (m) separate closed piece of the surface, 0-based
  int shells;
  Neighbors neighbors;
  std::vector<std::array<bool, 3>> line;  // (m) whether the edge from corner k is a feature line
};
Patches find_patches(const SurfaceMesh& surface, double feature_angle);

// The feature lines, also those that end inside a patch, cut into polylines at points where three
// or more lines meet or one ends, where the pair of patches beside the line changes, and where the
// line itself turns by more than 45 degrees.
struct FeatureLine {
  std::vector<int> points;      // indices; first == last on a closed line
  std::pair<int, int> patches;  // beside it, the smaller first; equal if it ends inside a patch
  bool starts_at_corner;        // false only for closed lines without any corner
};
std::vector<FeatureLine> find_feature_lines(const SurfaceMesh& surface, const Patches& patches);

// Replaces the faces by unnamed ones, one for each piece that is bounded by edges sharper than
// `feature_angle` [rad].
void label_by_angle(SurfaceMesh& surface, double feature_angle);

}  // namespace codesign::fem
