#pragma once

#include <vector>

#include "fem/meshing/mesh_options.hpp"
#include "fem/meshing/size_field.hpp"
#include "fem/surface/solid_oracle.hpp"
#include "fem/surface/surface_features.hpp"
#include "fem/surface/surface_mesh.hpp"
#include "fem/surface/surface_simplify.hpp"
#include "fem/surface/topology.hpp"

namespace codesign::fem {

// A surface as the mesher takes it: without tiny edges, cut into patches along feature lines.
struct PreparedSurface {
  SurfaceMesh surface;
  SimplifyReport simplified;
  Topology topology;
  Patches patches;
  std::vector<FeatureLine> lines;
  SolidOracle oracle;
};

// Simplified by options.simplify, never more than 0.0005 of the extent and 0.1 of the smallest edge
// length, and not at all if that changed the topology. Throws MeshError if the surface bounds no
// solid or (options.check_intersections) crosses itself.
PreparedSurface prepare_surface(const SurfaceMesh& input, const SizeField& size,
                                const MeshOptions& options);

// Whether a point of the surface lies on a feature line, within `tolerance` [m].
bool on_feature_line(const PreparedSurface& prepared, const SolidOracle::Hit& hit,
                     double tolerance);

}  // namespace codesign::fem
