#pragma once

#include "fem/meshing/linear_tets.hpp"
#include "fem/meshing/mesh_watch.hpp"
#include "fem/surface/solid_oracle.hpp"

namespace codesign::fem {

// Improves tetrahedra that have a dihedral angle below `angle` or above 180° - `angle` [rad]: edges
// and sides inside the solid are replaced by others, points are moved (points of a patch on their
// patch; points on lines stay). Each step raises the smallest sine of a dihedral angle around it,
// so nothing gets worse and the work is bounded. Side labels are patches of the oracle. Returns how
// many such tetrahedra remain. Throws MeshLimitError of `watch`.
// Source of the steps: L. Freitag, C. Ollivier-Gooch, "Tetrahedral mesh improvement using swapping
// and smoothing", Int. J. Numer. Meth. Eng. 40 (1997).
int improve_tets(LinearTets& mesh, double angle, const SolidOracle& oracle, MeshWatch& watch);

}  // namespace codesign::fem
