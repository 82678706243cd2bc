#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// Up to `most` pairs of triangles that cross each other; those that share a corner or an edge may
// touch there. A triangle whose corners lie on one line makes a pair with itself. Exact
// predicates. Throws MeshError if the surface touches itself in a point.
std::vector<std::pair<int, int>> crossing_triangles(const SurfaceMesh& surface, int most);

// Throws MeshError if two triangles cross each other, with a place; triangles that share a corner
// or an edge may touch there. Exact predicates.
void check_self_intersection(const SurfaceMesh& surface);

// A triangle: the numbers of its corners and where they are.
struct Facet {
  std::array<int, 3> point;
  std::array<Eigen::Vector3d, 3> at;  // m
};

// Whether the corners lie on one line. Exact.
bool is_degenerate(const Facet& facet);

// Whether two triangles cross each other, by the rule of crossing_triangles. Exact predicates;
// neither may be degenerate.
bool facets_cross(const Facet& s, const Facet& t);

}  // namespace codesign::fem
