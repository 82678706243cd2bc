#pragma once

#include <Eigen/Core>

#include "fem/boundary/supports.hpp"
#include "fem/elasticity/substructure.hpp"
#include "fem/mesh/material.hpp"
#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// Displacements (3 n, k) m under loads (3 n, k) N, from those of the supports on: conjugate
// gradients on the elements themselves, the factor as preconditioner, side by side. Each column
// ends with its relative residual below the tolerance, or after so many steps that the factor is
// known to be too coarse for the part.
Eigen::MatrixXd condensed_solution(const CondensedFactor& factor, const TetMesh& mesh,
                                   const Material& material, const Constraints& constraints,
                                   const Eigen::MatrixXd& loads, double tolerance);

}  // namespace codesign::fem
