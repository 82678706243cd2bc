#pragma once

#include <string>
#include <vector>

#include "fem/boundary/supports.hpp"
#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// The motions without strain that the constraints leave free, in words ("translation along x",
// "rotation about z through (0, 0.1, 0)"); empty if the model is held. Pieces of the mesh that
// share faces move as one body; bodies that share only single nodes or edges are joined there, so a
// hinge is found too.
std::vector<std::string> free_rigid_motions(const TetMesh& mesh, const Constraints& constraints);

// Throws SolverError naming the free rigid motions, if there are any.
void require_held(const TetMesh& mesh, const Constraints& constraints);

}  // namespace codesign::fem
