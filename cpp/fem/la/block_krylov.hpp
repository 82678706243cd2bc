#pragma once

#include <Eigen/Core>
#include <functional>

namespace codesign::fem {

// A x for a symmetric matrix A that need not be stored.
using LinearMap = std::function<Eigen::VectorXd(const Eigen::VectorXd& x)>;

// A times the columns of v, for an operator A that is self-adjoint in the inner product of a
// positive definite matrix M: vᵀ M A w = wᵀ M A v. The columns of mv are M v.
using SelfAdjoint =
    std::function<Eigen::MatrixXd(const Eigen::MatrixXd& v, const Eigen::MatrixXd& mv)>;

// Which eigenvalues are sought, how exactly.
struct WantedEigenvalues {
  Eigen::Index largest = 1;   // how many of the greatest
  Eigen::Index smallest = 0;  // how many of the least
  double tolerance = 1e-9;    // relative change of a converged eigenvalue
  double negligible = 0.0;    // a value of smaller magnitude need only be seen to stay so small
};

// Whether the values have come to rest since the last ones.
bool converged(const Eigen::VectorXd& value, const Eigen::VectorXd& last,
               const WantedEigenvalues& wanted);

// The largest eigenvalues, descending, then the smallest, ascending; vectors are columns,
// orthonormal in the inner product.
struct Eigenpairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

// Block Lanczos method with full reorthogonalization (Rayleigh-Ritz on a block Krylov space), until
// the wanted eigenvalues have converged.
// inner: M. start: a block of vectors, smooth ones for elliptic problems. Throws SolverError if the
// eigenvalues do not converge.
Eigenpairs extreme_eigenpairs(const LinearMap& inner, const SelfAdjoint& apply,
                              Eigen::MatrixXd start, const WantedEigenvalues& wanted);

// Numbers between -1 and 1, the same on every machine: a block to start from.
Eigen::MatrixXd random_block(Eigen::Index rows, Eigen::Index columns);

}  // namespace codesign::fem
