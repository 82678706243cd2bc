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

// A place where the boundary of a mesh goes another way than its surface, and about how large the
// fault is.
struct Mismatch {
  Eigen::Vector3d place;  // m
  double size;            // m
  double length;          // of the edges of the mesh there, m
};

// Where a boundary of another topology than its surface goes wrong, the largest first: it is not
// manifold (size: the edge, or the shortest one at the point), or sides stand across the surface
// (size: how far their middle is from it); if there are none, edges between two patches that are
// off one of them; if there are none, the place of the largest distance. mesh.boundary_face:
// patches of the surface.
std::vector<Mismatch> find_mismatches(const TetMesh& mesh, const SurfaceMesh& surface,
                                      const SolidOracle& oracle);

}  // namespace codesign::fem
