#pragma once

#include <vector>

#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// Up to 12 triangles of shell `which`, far from each other. shell: of each triangle.
std::vector<int> spread_triangles(const SurfaceMesh& surface, const std::vector<int>& shell,
                                  int which);

}  // namespace codesign::fem
