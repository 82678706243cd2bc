#pragma once

#include "errors.hpp"
#include "fem/meshing/linear_tets.hpp"
#include "fem/meshing/mesh_options.hpp"
#include "fem/meshing/mesh_watch.hpp"
#include "fem/meshing/prepared_surface.hpp"
#include "fem/meshing/size_field.hpp"

namespace codesign::fem {

// What another attempt at a solid does beside smaller elements.
struct Attempt {
  bool separate_patches =
      false;                 // refine sides with corners inside two patches, across thin wedges
  bool clear_balls = false;  // keep protecting balls out of patches that their line does not border
  bool seed_shells = false;  // start with points on every shell, not only on those without lines
};

// The refinement filled nothing, or its rounding errors contradict each other; another size leaves
// that arrangement of points.
struct MeshBreakdown : MeshError {
  using MeshError::MeshError;
};

// Delaunay refinement of the solid inside the surface; sides are labeled by patch. Throws
// MeshLimitError on the limits of `options` and `watch`, MeshBreakdown.
LinearTets delaunay_mesh(const PreparedSurface& prepared, const SizeField& size,
                         const MeshOptions& options, Attempt attempt, MeshWatch& watch);

}  // namespace codesign::fem
