#pragma once

#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// Removes caps that fold the surface: triangles lower than `tolerance` [m] over their longest edge
// with all three edges sharper than `feature_angle` [rad]. Between these lines, which run within
// the tolerance of each other, no mesh would come to an end. The longest edge is turned, so
// that the cap becomes part of the triangle beyond it; the surface moves by the height of the cap.
// Returns the largest of these heights [m], 0 if there is no cap. Topology and names of faces stay.
double flip_caps(SurfaceMesh& surface, double tolerance, double feature_angle);

}  // namespace codesign::fem
