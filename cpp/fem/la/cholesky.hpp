#pragma once

#include <Eigen/Core>
#include <memory>

#include "fem/la/lower_matrix.hpp"
#include "fem/la/ordering.hpp"

namespace codesign::fem {

// Cholesky factor of a symmetric positive definite matrix whose order is already fill-reducing
// (CHOLMOD's supernodal factorization).
class CholeskyFactor {
 public:
  // Throws SolverError if the matrix is not positive definite or memory runs out.
  CholeskyFactor(const NodePattern& pattern, const LowerMatrix& matrix);
  ~CholeskyFactor();
  CholeskyFactor(CholeskyFactor&&) noexcept;
  CholeskyFactor& operator=(CholeskyFactor&&) noexcept;

  // One column per right-hand side. May be called from several threads at once.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right_hand_side) const;

  double nonzeros() const;  // of the factor

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace codesign::fem
