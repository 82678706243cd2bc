#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/la/factor_structure.hpp"
#include "fem/la/lower_matrix.hpp"
#include "fem/la/ordering.hpp"

namespace codesign::fem {

// A symmetric matrix, of which the lower triangle is read, between equations that a pattern
// couples, each with each.
struct DenseBlock {
  Eigen::MatrixXf value;       // (k, k)
  std::vector<int> equations;  // (k) ascending
};

// Cholesky factor in single precision of a matrix whose order is already fill-reducing: half the
// memory of one in double precision, and on wide vector units half the time. Its solutions have few
// digits and are refined with the matrix itself. Multifrontal (Liu, The multifrontal method for
// sparse matrix solution, SIAM Review 34, 1992).
class SingleFactor {
 public:
  // The last equations, as many as `left`, are not eliminated. Throws SolverError if a pivot is not
  // positive, in six digits.
  SingleFactor(const NodePattern& pattern, const LowerMatrix& matrix, int left = 0,
               const std::vector<DenseBlock>& blocks = {});

  // The Schur complement of those that are left, its lower triangle: (left, left).
  const Eigen::MatrixXf& complement() const { return complement_; }

  // In place, of all equations, a column for each right-hand side; with none left the two after one
  // another solve. solve_lower: forces half eliminated; those on equations that are left are what
  // acts on the complement. solve_upper: the solution, from forces half eliminated and the solution
  // of what is left.
  void solve_lower(Eigen::MatrixXf& x) const;
  void solve_upper(Eigen::MatrixXf& x) const;

  double bytes() const;

 private:
  class Elimination;

  int eliminated(int supernode) const;  // columns

  FactorStructure structure_;
  int left_;
  std::vector<std::size_t> start_;  // (s + 1) first entry of a supernode
  std::vector<float> value_;        // (height, eliminated) of each supernode, by columns
  Eigen::MatrixXf complement_;
};

}  // namespace codesign::fem
