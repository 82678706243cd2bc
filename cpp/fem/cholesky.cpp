#include "fem/cholesky.hpp"

#include <cholmod.h>

#include "errors.hpp"

namespace codesign::fem {

struct CholeskyFactor::Data {
  cholmod_common common;
  cholmod_factor* factor = nullptr;

  Data() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_NATURAL;
    common.postorder = 0;
    common.quick_return_if_not_posdef = 1;
  }
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;
  ~Data() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
};

namespace {

// CHOLMOD reads the matrix in place; it never writes to it.
cholmod_sparse view(const LowerMatrix& a) {
  cholmod_sparse s{};
  s.nrow = s.ncol = static_cast<std::size_t>(a.size());
  s.nzmax = a.row.size();
  s.p = const_cast<int*>(a.start.data());
  s.i = const_cast<int*>(a.row.data());
  s.x = const_cast<double*>(a.value.data());
  s.stype = -1;
  s.itype = CHOLMOD_INT;
  s.xtype = CHOLMOD_REAL;
  s.dtype = CHOLMOD_DOUBLE;
  s.sorted = 1;
  s.packed = 1;
  return s;
}

}  // namespace

CholeskyFactor::CholeskyFactor(const NodePattern& pattern, const LowerMatrix& matrix)
    : data_(std::make_unique<Data>()) {
  (void)pattern;
  cholmod_sparse a = view(matrix);
  data_->factor = cholmod_analyze(&a, &data_->common);
  if (data_->factor != nullptr) cholmod_factorize(&a, data_->factor, &data_->common);
  if (data_->common.status == CHOLMOD_NOT_POSDEF) {
    throw SolverError("the stiffness matrix is not positive definite");
  }
  if (data_->common.status != CHOLMOD_OK) {
    throw SolverError("the factorisation failed: out of memory or too large");
  }
}

CholeskyFactor::~CholeskyFactor() = default;
CholeskyFactor::CholeskyFactor(CholeskyFactor&&) noexcept = default;
CholeskyFactor& CholeskyFactor::operator=(CholeskyFactor&&) noexcept = default;

Eigen::MatrixXd CholeskyFactor::solve(const Eigen::MatrixXd& right_hand_side) const {
  cholmod_dense b{};
  b.nrow = b.d = static_cast<std::size_t>(right_hand_side.rows());
  b.ncol = static_cast<std::size_t>(right_hand_side.cols());
  b.nzmax = b.nrow * b.ncol;
  b.x = const_cast<double*>(right_hand_side.data());
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* x = cholmod_solve(CHOLMOD_A, data_->factor, &b, &data_->common);
  if (x == nullptr) throw SolverError("the triangular solution failed: out of memory");
  Eigen::MatrixXd result = Eigen::Map<const Eigen::MatrixXd>(
      static_cast<const double*>(x->x), right_hand_side.rows(), right_hand_side.cols());
  cholmod_free_dense(&x, &data_->common);
  return result;
}

double CholeskyFactor::nonzeros() const { return static_cast<double>(data_->factor->xsize); }

}  // namespace codesign::fem
