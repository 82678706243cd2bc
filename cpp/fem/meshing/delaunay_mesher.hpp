#pragma once

#include "fem/meshing/linear_tets.hpp"
#include "fem/meshing/mesh_options.hpp"
#include "fem/meshing/mesh_watch.hpp"
#include "fem/meshing/prepared_surface.hpp"
#include "fem/meshing/size_field.hpp"

namespace codesign::fem {

// Delaunay refinement of the solid inside the surface; sides are labelled by patch. With
// `separate_patches`, sides with corners inside two patches are refined too: they stand across a
// thin wedge. Throws MeshLimitError on the limits of `options` and `watch`, MeshError if the
// refinement breaks down.
LinearTets delaunay_mesh(const PreparedSurface& prepared, const SizeField& size,
                         const MeshOptions& options, bool separate_patches, MeshWatch& watch);

}  // namespace codesign::fem
