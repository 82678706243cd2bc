#pragma once

#include "fem/linear_tets.hpp"
#include "fem/size_field.hpp"
#include "fem/solid_oracle.hpp"
#include "fem/surface_features.hpp"
#include "fem/tet_mesher.hpp"

namespace codesign::fem {

// Delaunay refinement of the solid inside the surface; sides are labelled by patch. Throws
// MeshError on the limits of `options` and if the refinement breaks down.
LinearTets delaunay_mesh(const SurfaceMesh& surface, const Patches& patches,
                         const std::vector<FeatureLine>& lines, const SolidOracle& oracle,
                         const SizeField& size, const MeshOptions& options);

}  // namespace codesign::fem
