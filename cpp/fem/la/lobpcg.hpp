#pragma once

#include <Eigen/Core>

#include "fem/la/block_krylov.hpp"

namespace codesign::fem {

// A x = value B x: A symmetric, B positive definite. `precondition` is about the inverse of A - s B
// for some s below the least eigenvalue; of its quality depends how many rounds it takes, not what
// comes out.
struct SymmetricPencil {
  LinearMap a, b, precondition;
};

// The wanted.smallest eigenvalues of the least, ascending, without any factor of A or B: locally
// optimal block preconditioned conjugate gradients, in memory for three blocks of vectors. Vectors
// are columns, orthonormal in B. start: a block with at least as many columns. Throws SolverError
// if the values do not converge.
// Source: A. Knyazev, SIAM J. Sci. Comput. 23 (2001); the basis by Duersch et al., SIAM J. Sci.
// Comput. 40 (2018).
Eigenpairs lowest_eigenpairs(const SymmetricPencil& pencil, const Eigen::MatrixXd& start,
                             const WantedEigenvalues& wanted);

}  // namespace codesign::fem
