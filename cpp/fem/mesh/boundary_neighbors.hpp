#pragma once

#include "fem/mesh/tet_mesh.hpp"
#include "fem/surface/surface_features.hpp"

namespace codesign::fem {

// For each side of mesh.boundary those across its three edges, found by turning about the edge
// through the elements: also at edges that more than two sides share, every side has the one on the
// other end of the same material.
Neighbors boundary_neighbors(const TetMesh& mesh);

}  // namespace codesign::fem
