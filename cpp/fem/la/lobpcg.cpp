#include "fem/la/lobpcg.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "errors.hpp"
#include "interrupt.hpp"

namespace codesign::fem {

namespace {

constexpr int kMostRounds = 300;
constexpr double kDependent = 1e-13;  // a direction of the basis with less than this is rounding
constexpr Eigen::Index kRows = 4096;  // that are combined at once

// The basis [X W P], X the approximations, W their preconditioned residuals, P the last steps, and
// the pencil seen from it.
class Rounds {
 public:
  Rounds(const SymmetricPencil& pencil, const Eigen::MatrixXd& start)
      : pencil_(pencil),
        block_(start.cols()),
        basis_(start.rows(), 3 * block_),
        a_(Eigen::MatrixXd::Zero(3 * block_, 3 * block_)),
        b_(a_) {
    basis_.leftCols(block_) = start;
    used_ = block_;
    project(0);
    combine();
  }

  const Eigen::VectorXd& values() const { return values_; }
  Eigen::MatrixXd vectors(Eigen::Index count) const { return basis_.leftCols(count); }

  void advance() {
    const Eigen::Index steps = used_ - block_;  // columns of P, which stand after X
    basis_.middleCols(2 * block_, steps) = basis_.middleCols(block_, steps).eval();
    for (Eigen::Index k = 0; k < block_; ++k) {
      check_interrupt();
      const Eigen::VectorXd x = basis_.col(k), ax = pencil_.a(x), bx = pencil_.b(x);
      a_.block(0, k, block_, 1).noalias() = basis_.leftCols(block_).transpose() * ax;
      b_.block(0, k, block_, 1).noalias() = basis_.leftCols(block_).transpose() * bx;
      Eigen::VectorXd w = pencil_.precondition(ax - values_[k] * bx);
      const double size = w.norm();
      if (size > 0.0) w /= size;
      basis_.col(block_ + k) = w;
    }
    used_ = 2 * block_ + steps;
    project(block_);
    combine();
  }

 private:
  // The pencil on the columns of the basis from `first` on, with all others.
  void project(Eigen::Index first) {
    for (Eigen::Index k = first; k < used_; ++k) {
      check_interrupt();
      const Eigen::VectorXd s = basis_.col(k);
      a_.block(0, k, k + 1, 1).noalias() = basis_.leftCols(k + 1).transpose() * pencil_.a(s);
      b_.block(0, k, k + 1, 1).noalias() = basis_.leftCols(k + 1).transpose() * pencil_.b(s);
    }
  }

  // The best approximations that the basis holds become X, what they gained from W and P becomes P.
  void combine() {
    const Eigen::MatrixXd a = a_.topLeftCorner(used_, used_).selfadjointView<Eigen::Upper>();
    const Eigen::MatrixXd b = b_.topLeftCorner(used_, used_).selfadjointView<Eigen::Upper>();
    const Eigen::VectorXd scale = b.diagonal().array().max(0.0).sqrt().unaryExpr(
        [](double d) { return d > 0 ? 1 / d : 0.0; });
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> gram(scale.asDiagonal() * b *
                                                              scale.asDiagonal());
    const Eigen::Index kept = (gram.eigenvalues().array() > kDependent).count();
    if (kept < block_) throw SolverError("the eigenvalues of the part have not converged");
    const Eigen::MatrixXd basis =
        scale.asDiagonal() * gram.eigenvectors().rightCols(kept) *
        gram.eigenvalues().tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz(basis.transpose() * a * basis);
    values_ = ritz.eigenvalues().head(block_);
    const Eigen::MatrixXd to_x = basis * ritz.eigenvectors().leftCols(block_);
    Eigen::MatrixXd to_p = to_x;
    to_p.topRows(block_).setZero();
    const bool steps = used_ > block_;
    for (Eigen::Index row = 0; row < basis_.rows(); row += kRows) {
      auto part = basis_.middleRows(row, std::min(kRows, basis_.rows() - row));
      const Eigen::MatrixXd x = part.leftCols(used_) * to_x, p = part.leftCols(used_) * to_p;
      part.leftCols(block_) = x;
      if (steps) part.middleCols(block_, block_) = p;
    }
    used_ = steps ? 2 * block_ : block_;
  }

  const SymmetricPencil& pencil_;
  Eigen::Index block_, used_ = 0;
  Eigen::MatrixXd basis_, a_, b_;
  Eigen::VectorXd values_;
};

}  // namespace

Eigenpairs lowest_eigenpairs(const SymmetricPencil& pencil, const Eigen::MatrixXd& start,
                             const WantedEigenvalues& wanted) {
  Rounds rounds(pencil, start);
  Eigen::VectorXd last = rounds.values().head(wanted.smallest);
  for (int round = 0; round < kMostRounds; ++round) {
    rounds.advance();
    const Eigen::VectorXd value = rounds.values().head(wanted.smallest);
    if (converged(value, last, wanted)) return {value, rounds.vectors(wanted.smallest)};
    last = value;
  }
  throw SolverError("the eigenvalues of the part have not converged");
}

}  // namespace codesign::fem
