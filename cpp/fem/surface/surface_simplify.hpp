#pragma once

#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// What a simplification did.
struct SimplifyReport {
  int collapsed = 0;      // edges
  double distance = 0.0;  // the farthest that any point moved, m
};

// Collapses edges that are so short that both ends meet within `tolerance` [m] of where they were:
// tiny edges and narrow ledges, which a mesher would have to fill with tiny elements. Corners stay
// before points on lines, those before points on smooth surface. Names of faces survive; an edge
// stays if its collapse would turn a triangle over, change the topology or remove a named face.
// feature_angle [rad]: what counts as a line.
SimplifyReport simplify_surface(SurfaceMesh& surface, double tolerance, double feature_angle);

// The same for a surface that must not cross itself: if it does after the collapses, they are
// undone and made again, each with a test whether a triangle that it moves crosses another. Throws
// MeshError (check_self_intersection) only for what crossed before.
SimplifyReport simplify_without_crossing(SurfaceMesh& surface, double tolerance,
                                         double feature_angle);

}  // namespace codesign::fem
