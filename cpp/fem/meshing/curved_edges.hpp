#pragma once

#include <vector>

#include "fem/mesh/tet_mesh.hpp"
#include "fem/meshing/mesh_watch.hpp"
#include "fem/surface/solid_oracle.hpp"
#include "fem/surface/surface_features.hpp"
#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// Moves the mid-edge nodes of the boundary onto the surface (those on feature lines onto the line),
// so that a few large elements follow a round part. `patch`: the patch of each boundary triangle. A
// node goes part of the way, or stays in the middle of its edge, where an element would get a
// Jacobian below a tenth of the straight element's. Returns the number of nodes that moved.
// Throws MeshLimitError of `watch`.
int curve_edges(TetMesh& mesh, const std::vector<int>& patch, const SurfaceMesh& surface,
                const std::vector<FeatureLine>& lines, const SolidOracle& oracle, MeshWatch& watch);

}  // namespace codesign::fem
