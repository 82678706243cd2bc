#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/mesh/tet_mesh.hpp"
#include "fem/surface/solid_oracle.hpp"
#include "fem/surface/surface_features.hpp"
#include "fem/surface/surface_mesh.hpp"
#include "fem/surface/topology.hpp"

namespace codesign::fem {

// Corner triangles of the boundary.
Triangles boundary_triangles(const TetMesh& mesh);

// The farthest that boundary and surface are from each other, both ways: nodes and middles of the
// boundary's sides, points and middles of the surface's triangles.
struct SurfaceDistance {
  double distance;        // m
  Eigen::Vector3d place;  // m
};
SurfaceDistance surface_distance(const TetMesh& mesh, const SurfaceMesh& surface,
                                 const SolidOracle& oracle);

// Places where a boundary of another topology than its surface goes wrong: it is not manifold,
// edges between two patches are far from one of them, sides stand across the surface; at least the
// place of the largest distance. mesh.boundary_face: patches of the surface.
std::vector<Eigen::Vector3d> find_mismatches(const TetMesh& mesh, const SurfaceMesh& surface,
                                             const SolidOracle& oracle);

}  // namespace codesign::fem
