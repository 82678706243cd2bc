#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// The vector c for which the pressure max(0, -n·c) on boundary triangles (n: outward normal) has
// the resultant `force` (N): on a bore or pin the cosine distribution 2 F / (pi r L) cos(theta)
// over the half that is pressed. Throws ModelError if no pressure has that resultant: a part of it
// lies along the axis of the bore, or it pulls away from a face that is less than half round.
Eigen::Vector3d bearing_pressure(const TetMesh& mesh, const std::vector<int>& triangles,
                                 const Eigen::Vector3d& force);

}  // namespace codesign::fem
