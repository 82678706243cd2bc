#include "fem/la/cholesky.hpp"

#include <cholmod.h>

#include <cmath>
#include <cstddef>
#include <string>

#include "errors.hpp"
#include "fem/la/cholmod_view.hpp"
#include "fem/la/one_thread.hpp"
#include "fem/la/symbolic_factor.hpp"
#include "interrupt.hpp"

namespace codesign::fem {

namespace {

// CHOLMOD's settings and workspace.
struct Workspace {
  cholmod_common common;

  Workspace() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_NATURAL;
    common.postorder = 0;
    common.quick_return_if_not_posdef = 1;
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
  ~Workspace() { cholmod_finish(&common); }
};

}  // namespace

struct CholeskyFactor::Data : Workspace {
  cholmod_factor* factor = nullptr;

  ~Data() { cholmod_free_factor(&factor, &common); }
};

CholeskyFactor::CholeskyFactor(const NodePattern& pattern, const LowerMatrix& matrix)
    : data_(std::make_unique<Data>()) {
  check_interrupt();
  const OneThread guard;
  cholmod_sparse a = cholmod_view(matrix);
  cholmod_common& common = data_->common;
  data_->factor = symbolic_factor(pattern, common);
  double no_shift[2] = {0.0, 0.0};
  if (data_->factor != nullptr) {
    cholmod_super_numeric(&a, nullptr, no_shift, data_->factor, &common);
  }
  if (common.status == CHOLMOD_NOT_POSDEF) {
    throw SolverError("the stiffness matrix is not positive definite");
  }
  if (common.status != CHOLMOD_OK) {
    throw MemoryLimitError(
        "the factorization of " + std::to_string(matrix.size()) + " equations needs " +
        std::to_string(std::lround(pattern.supernodes.entries * 8.0 / (1 << 20))) +
        " MiB, which the process cannot get: larger elements or the iterative "
        "solver are needed");
  }
}

CholeskyFactor::~CholeskyFactor() = default;
CholeskyFactor::CholeskyFactor(CholeskyFactor&&) noexcept = default;
CholeskyFactor& CholeskyFactor::operator=(CholeskyFactor&&) noexcept = default;

namespace {

// system: one of CHOLMOD's, as CHOLMOD_A.
Eigen::MatrixXd solve_system(int system, cholmod_factor* factor,
                             const Eigen::Ref<const Eigen::MatrixXd>& right_hand_side) {
  check_interrupt();
  const OneThread guard;
  Workspace workspace;  // of this call: CHOLMOD writes to it, and calls may run side by side
  cholmod_dense b{};
  b.nrow = b.d = static_cast<std::size_t>(right_hand_side.rows());
  b.ncol = static_cast<std::size_t>(right_hand_side.cols());
  b.nzmax = b.nrow * b.ncol;
  b.x = const_cast<double*>(right_hand_side.data());
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* x = cholmod_solve(system, factor, &b, &workspace.common);
  if (x == nullptr) throw SolverError("the triangular solution failed: out of memory");
  Eigen::MatrixXd result = Eigen::Map<const Eigen::MatrixXd>(
      static_cast<const double*>(x->x), right_hand_side.rows(), right_hand_side.cols());
  cholmod_free_dense(&x, &workspace.common);
  return result;
}

}  // namespace

Eigen::MatrixXd CholeskyFactor::solve(const Eigen::MatrixXd& right_hand_side) const {
  return solve_system(CHOLMOD_A, data_->factor, right_hand_side);
}

Eigen::VectorXd CholeskyFactor::solve_lower(const Eigen::VectorXd& right_hand_side) const {
  return solve_system(CHOLMOD_L, data_->factor, right_hand_side);
}

Eigen::VectorXd CholeskyFactor::solve_upper(const Eigen::VectorXd& right_hand_side) const {
  return solve_system(CHOLMOD_Lt, data_->factor, right_hand_side);
}

Eigen::MatrixXd CholeskyFactor::block(const std::vector<int>& equations) const {
  const cholmod_factor& l = *data_->factor;
  const auto *super = static_cast<const int*>(l.super), *pi = static_cast<const int*>(l.pi);
  const auto *px = static_cast<const int*>(l.px), *rows = static_cast<const int*>(l.s);
  const auto* values = static_cast<const double*>(l.x);
  const auto count = static_cast<Eigen::Index>(equations.size());
  std::vector<Eigen::Index> wanted(l.n, -1);
  for (Eigen::Index k = 0; k < count; ++k) wanted[static_cast<std::size_t>(equations[k])] = k;
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(count, count);
  for (std::size_t s = 0; s < l.nsuper; ++s) {
    const int height = pi[s + 1] - pi[s];
    for (int column = super[s]; column < super[s + 1]; ++column) {
      const Eigen::Index to = wanted[static_cast<std::size_t>(column)];
      if (to < 0) continue;
      const double* entry =
          values + px[s] + static_cast<std::ptrdiff_t>(height) * (column - super[s]);
      for (int i = column - super[s]; i < height; ++i) {
        const Eigen::Index row = wanted[static_cast<std::size_t>(rows[pi[s] + i])];
        if (row >= 0) block(row, to) = entry[i];
      }
    }
  }
  return block;
}

double CholeskyFactor::nonzeros() const { return static_cast<double>(data_->factor->xsize); }

}  // namespace codesign::fem
