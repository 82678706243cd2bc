#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/elasticity/stiffness.hpp"
#include "fem/la/cholesky.hpp"
#include "fem/la/ordering.hpp"
#include "fem/mesh/material.hpp"

namespace codesign::fem {

// Approximate inverse of the stiffness for models whose factor does not fit into memory: symmetric
// Gauss-Seidel on all equations around an exact solution of the same model with four-node
// elements, whose equations are those of the corner nodes (about an eighth). Symmetric positive
// definite. Refers to `stiffness`, which must outlive it and is K + shift M.
// Source: p-multigrid with two levels (Ronquist and Patera 1987).
class TwoLevelPreconditioner {
 public:
  // Throws MemoryLimitError if `stiffness` and the coarse factor need more bytes than the limit.
  TwoLevelPreconditioner(const TetMesh& mesh, const Material& material,
                         const Constraints& constraints, const NodePattern& pattern,
                         const LowerMatrix& stiffness, double memory_limit, double shift = 0.0);

  Eigen::VectorXd apply(const Eigen::VectorXd& residual) const;

  double bytes() const;  // of its factor

 private:
  // A free equation follows the mean of up to two coarse equations; the same one twice at a corner.
  struct Parents {
    int first = -1, second = -1;
  };

  const LowerMatrix& stiffness_;
  NodePattern coarse_pattern_;
  std::vector<Parents> parents_;
  CholeskyFactor coarse_;
};

// A solution and what it took.
struct ConjugateGradientResult {
  Eigen::VectorXd solution;
  int iterations = 0;
  bool converged = false;
};

// Preconditioned conjugate gradients until the preconditioned residual has fallen by `tolerance`.
ConjugateGradientResult conjugate_gradients(const LowerMatrix& matrix,
                                            const TwoLevelPreconditioner& preconditioner,
                                            const Eigen::VectorXd& right_hand_side,
                                            double tolerance, int max_iterations);

}  // namespace codesign::fem
