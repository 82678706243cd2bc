#pragma once

#include "fem/meshing/linear_tets.hpp"
#include "fem/meshing/mesh_options.hpp"
#include "fem/meshing/size_field.hpp"
#include "fem/surface/solid_oracle.hpp"
#include "fem/surface/surface_features.hpp"

namespace codesign::fem {

// Delaunay refinement of the solid inside the surface; sides are labelled by patch. Throws
// MeshError on the limits of `options` and if the refinement breaks down.
LinearTets delaunay_mesh(const SurfaceMesh& surface, const Patches& patches,
                         const std::vector<FeatureLine>& lines, const SolidOracle& oracle,
                         const SizeField& size, const MeshOptions& options);

}  // namespace codesign::fem
