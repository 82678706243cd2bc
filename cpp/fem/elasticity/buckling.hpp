#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "fem/boundary/supports.hpp"
#include "fem/elasticity/memory.hpp"
#include "fem/elasticity/natural_modes.hpp"
#include "fem/elasticity/two_level.hpp"
#include "fem/la/cholesky.hpp"
#include "fem/la/ordering.hpp"
#include "fem/mesh/material.hpp"
#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// Linear buckling, (K + factor K_sigma) x = 0: K_sigma, with the blocks ∫ ∇N_a·σ·∇N_b dV I, is the
// geometric stiffness of the stress σ under the load, which keeps its direction and grows in
// proportion.
//
// K⁻¹ K_sigma is no compact operator: its eigenvalues of about stress / shear modulus are a
// continuum (short waves, like wrinkles of a compressed surface, drawn to singular stresses) of
// which every mesh shows other ones. What counts is a mode that turns the part more than it strains
// it: one that buckles at a mean stress below a quarter of the shear modulus, G / 4, weighted by
// |grad x|². Factors are sought up to the one that stresses 1 % of the part beyond G / 4, far more
// than any material bears, or to the last of the modes asked for if some of them do not count.
struct BucklingModes {
  Eigen::VectorXd factor;  // (k <= count) of the load, > 0, ascending; empty: none up to the limit
  Eigen::MatrixXd shape;  // (3 n, k) column: x y z of node 0, then node 1 ...; largest node moves 1
  double reversed = std::numeric_limits<double>::infinity();  // lowest of the load reversed
  double limit = std::numeric_limits<double>::infinity();     // factor up to which was sought
};

// The lowest buckling modes on the supports under the load that gives the displacement (n, 3) m;
// prescribed displacements count as held. By a factor if it fits into the memory limit (bytes),
// else by iteration. Throws SolverError, MemoryLimitError, MeshError; std::invalid_argument if
// count < 1 or the displacement has another size.
BucklingModes buckling_modes(const TetMesh& mesh, const Material& material,
                             const std::vector<Support>& supports, const Points& displacement,
                             int count, double memory_limit = kMemoryLimit);

// The same from a factor of K, by the largest eigenvalues of -K⁻¹ K_sigma: self-adjoint in the
// inner product of K, while K_sigma, being indefinite, has none.
BucklingModes buckling_of_factor(const TetMesh& mesh, const Material& material,
                                 const NodePattern& pattern, const CholeskyFactor& factor,
                                 const Points& displacement, int count);

// The same without a factor, from the stiffness and its preconditioner.
BucklingModes buckling_by_iteration(const TetMesh& mesh, const Material& material,
                                    const NodePattern& pattern, const LowerMatrix& stiffness,
                                    const TwoLevelPreconditioner& preconditioner,
                                    const Points& displacement, int count);

}  // namespace codesign::fem
