#pragma once

#include "fem/surface/surface_features.hpp"
#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// Throws MeshError unless the closed surface bounds one solid, which may have cavities: several
// bodies are named with volume and place, and so is a shell that is inside-out but lies in no
// other.
void check_one_body(const SurfaceMesh& surface, const Patches& patches);

}  // namespace codesign::fem
