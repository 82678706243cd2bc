#include "fem/la/block_krylov.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/random_stream.hpp"
#include "errors.hpp"
#include "interrupt.hpp"

namespace codesign::fem {

namespace {

constexpr double kNegligibleChange = 1e-2;  // of the limit of what is negligible
constexpr int kMaxBlocks = 40;

// Vectors that are orthonormal in the inner product of a matrix, with their products with it.
struct Basis {
  const LinearMap& inner;
  Eigen::MatrixXd v, mv;
  Eigen::Index size = 0;

  // Adds what a vector holds beyond the basis; nothing if that is rounding.
  void add(Eigen::VectorXd x) {
    const double before = std::sqrt(std::abs(x.dot(inner(x))));
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd along = mv.leftCols(size).transpose() * x;
      x.noalias() -= v.leftCols(size) * along;
    }
    const Eigen::VectorXd mx = inner(x);
    const double norm = std::sqrt(std::abs(x.dot(mx)));
    if (!(norm > 1e-10 * before)) return;
    if (size == v.cols()) {
      v.conservativeResize(Eigen::NoChange, 2 * size);
      mv.conservativeResize(Eigen::NoChange, 2 * size);
    }
    v.col(size) = x / norm;
    mv.col(size++) = mx / norm;
  }
};

// The operator seen from the basis; grows with it.
struct Projection {
  Eigen::MatrixXd matrix;

  // image: the operator applied to the columns that were added to the basis.
  void extend(const Basis& basis, const Eigen::MatrixXd& image) {
    const Eigen::Index added = image.cols(), before = basis.size - added;
    matrix.conservativeResize(basis.size, basis.size);
    matrix.rightCols(added) = basis.mv.leftCols(basis.size).transpose() * image;
    matrix.bottomLeftCorner(added, before) = matrix.topRightCorner(before, added).transpose();
  }
};

}  // namespace

bool converged(const Eigen::VectorXd& value, const Eigen::VectorXd& last,
               const WantedEigenvalues& wanted) {
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    const double change = std::abs(value[i] - last[i]), size = std::abs(value[i]);
    const bool negligible = size <= wanted.negligible;
    if (change > (negligible ? kNegligibleChange * wanted.negligible : wanted.tolerance * size)) {
      return false;
    }
  }
  return true;
}

Eigen::MatrixXd random_block(Eigen::Index rows, Eigen::Index columns) {
  RandomStream random(1);
  Eigen::MatrixXd block(rows, columns);
  for (Eigen::Index i = 0; i < block.size(); ++i) block.data()[i] = 2.0 * random.uniform() - 1.0;
  return block;
}

Eigenpairs extreme_eigenpairs(const LinearMap& inner, const SelfAdjoint& apply,
                              Eigen::MatrixXd start, const WantedEigenvalues& wanted) {
  const Eigen::Index n = start.rows(), capacity = 6 * start.cols();
  const Eigen::Index top = wanted.largest, bottom = wanted.smallest;
  Basis basis{inner, Eigen::MatrixXd(n, capacity), Eigen::MatrixXd(n, capacity)};
  Eigen::MatrixXd next = std::move(start);
  Projection projection;
  Eigen::VectorXd value(top + bottom), last = Eigen::VectorXd::Zero(top + bottom);
  for (int step = 0; step < kMaxBlocks; ++step) {
    const Eigen::Index before = basis.size;
    for (Eigen::Index k = 0; k < next.cols(); ++k) {
      check_interrupt();
      basis.add(next.col(k));
    }
    const Eigen::Index added = basis.size - before;
    if (added > 0) {
      next = apply(basis.v.middleCols(before, added), basis.mv.middleCols(before, added));
      projection.extend(basis, next);
    }
    if (basis.size < std::max(top, bottom)) break;
    const Eigen::MatrixXd symmetric = 0.5 * (projection.matrix + projection.matrix.transpose());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz(symmetric);  // ascending
    value << ritz.eigenvalues().tail(top).reverse(), ritz.eigenvalues().head(bottom);
    const bool still = converged(value, last, wanted);
    last = value;
    if (!still && added > 0) continue;
    Eigen::MatrixXd coefficients(basis.size, top + bottom);
    coefficients << ritz.eigenvectors().rightCols(top).rowwise().reverse(),
        ritz.eigenvectors().leftCols(bottom);
    return {value, basis.v.leftCols(basis.size) * coefficients};
  }
  throw SolverError("the eigenvalues of the part have not converged");
}

}  // namespace codesign::fem
