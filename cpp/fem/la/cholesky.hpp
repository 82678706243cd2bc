#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

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

  // The two halves of a solution, factor times x and factor transposed times x equal to the right.
  Eigen::VectorXd solve_lower(const Eigen::VectorXd& right_hand_side) const;
  Eigen::VectorXd solve_upper(const Eigen::VectorXd& right_hand_side) const;

  // Rows and columns of the factor, of ascending equations; lower triangular.
  Eigen::MatrixXd block(const std::vector<int>& equations) const;

  double nonzeros() const;  // of the factor

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace codesign::fem
