#include "fem/la/cholesky.hpp"

#include <cholmod.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <vector>

#include "errors.hpp"

// Of OpenBLAS and OpenMP, where they are linked.
extern "C" {
int openblas_get_num_threads() __attribute__((weak));
void openblas_set_num_threads(int threads) __attribute__((weak));
int omp_get_max_active_levels() __attribute__((weak));
void omp_set_max_active_levels(int levels) __attribute__((weak));
}

namespace codesign::fem {

namespace {

// Keeps BLAS and CHOLMOD on the calling thread while it lives: parallelism is between designs, and
// waiting threads of a busy machine cost more than they give (measured: twice the time).
// Of several at once the first one sets and the last one restores what belongs to the process.
class OneThread {
 public:
  OneThread() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (living_++ > 0) return;
    if (openblas_get_num_threads && openblas_set_num_threads) {
      blas_threads_ = openblas_get_num_threads();
      if (blas_threads_ != 1) openblas_set_num_threads(1);
    }
  }
  ~OneThread() {
    if (omp_levels_ > 0) omp_set_max_active_levels(omp_levels_);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (--living_ == 0 && blas_threads_ > 1) openblas_set_num_threads(blas_threads_);
  }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  static int deactivate_omp() {  // a setting of the calling thread
    if (!omp_get_max_active_levels || !omp_set_max_active_levels) return 0;
    const int levels = omp_get_max_active_levels();
    if (levels != 0) omp_set_max_active_levels(0);
    return levels;
  }

  static inline std::mutex mutex_;
  static inline int living_ = 0, blas_threads_ = 1;
  int omp_levels_ = deactivate_omp();
};

}  // namespace

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

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

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

// The pattern's supernodes as CHOLMOD's symbolic factor, in the natural order. It spares CHOLMOD's
// own analysis of the equations, which takes longer than ours of the nodes.
cholmod_factor* symbolic_factor(const NodePattern& pattern, cholmod_common& common) {
  const Supernodes& nodes = pattern.supernodes;
  const std::size_t n = at(pattern.equations()), count = at(nodes.count());
  cholmod_factor* l = cholmod_allocate_factor(n, &common);
  if (l == nullptr) return nullptr;
  const auto equations_of_rows = [&](int s) {
    int sum = 0;
    for (int p = nodes.row_start[at(s)]; p < nodes.row_start[at(s) + 1]; ++p) {
      const int row = nodes.row[at(p)];
      sum += pattern.dof_start[at(row) + 1] - pattern.dof_start[at(row)];
    }
    return sum;
  };
  std::vector<int> super(count + 1), pi(count + 1, 0), px(count + 1, 0), rows;
  std::vector<int> supernode_of(at(pattern.positions()));
  std::size_t entries = 0;
  for (std::size_t s = 0; s < count; ++s) {
    const int first = nodes.start[s], last = nodes.start[s + 1];
    for (int k = first; k < last; ++k) supernode_of[at(k)] = static_cast<int>(s);
    const int columns = pattern.dof_start[at(last)] - pattern.dof_start[at(first)];
    const int height = columns + equations_of_rows(static_cast<int>(s));
    super[s] = pattern.dof_start[at(first)];
    pi[s + 1] = pi[s] + height;
    entries += static_cast<std::size_t>(height) * at(columns);
    if (entries > std::numeric_limits<int>::max()) {
      cholmod_free_factor(&l, &common);
      common.status = CHOLMOD_TOO_LARGE;
      return nullptr;
    }
    px[s + 1] = static_cast<int>(entries);
  }
  super[count] = static_cast<int>(n);
  rows.reserve(at(pi[count]));
  // Largest update of a later supernode by an earlier one, and most rows below a supernode.
  std::size_t max_update = 1, max_below = 1;
  for (std::size_t s = 0; s < count; ++s) {
    for (int d = super[s]; d < super[s + 1]; ++d) rows.push_back(d);
    std::size_t below = at(pi[s + 1] - pi[s] - (super[s + 1] - super[s]));
    max_below = std::max(max_below, below);
    int p = nodes.row_start[s];
    while (p < nodes.row_start[s + 1]) {
      const int target = supernode_of[at(nodes.row[at(p)])];
      std::size_t wide = 0;
      for (; p < nodes.row_start[s + 1] && supernode_of[at(nodes.row[at(p)])] == target; ++p) {
        const int row = nodes.row[at(p)];
        for (int d = pattern.dof_start[at(row)]; d < pattern.dof_start[at(row) + 1]; ++d) {
          rows.push_back(d);
          ++wide;
        }
      }
      max_update = std::max(max_update, wide * below);
      below -= wide;
    }
  }
  const auto give = [&](const std::vector<int>& values) {
    void* memory = cholmod_malloc(values.size(), sizeof(int), &common);
    if (memory != nullptr) std::copy(values.begin(), values.end(), static_cast<int*>(memory));
    return memory;
  };
  l->ordering = CHOLMOD_NATURAL;
  l->is_super = 1;
  l->is_ll = 1;
  l->is_monotonic = 1;
  l->xtype = CHOLMOD_PATTERN;
  l->nsuper = count;
  l->ssize = rows.size();
  l->xsize = entries;
  l->maxcsize = max_update;
  l->maxesize = max_below;
  l->super = give(super);
  l->pi = give(pi);
  l->px = give(px);
  l->s = give(rows);
  if (common.status != CHOLMOD_OK) cholmod_free_factor(&l, &common);
  return l;
}

}  // namespace

CholeskyFactor::CholeskyFactor(const NodePattern& pattern, const LowerMatrix& matrix)
    : data_(std::make_unique<Data>()) {
  const OneThread guard;
  cholmod_sparse a = view(matrix);
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
    throw SolverError("the factorisation failed: out of memory or too large");
  }
}

CholeskyFactor::~CholeskyFactor() = default;
CholeskyFactor::CholeskyFactor(CholeskyFactor&&) noexcept = default;
CholeskyFactor& CholeskyFactor::operator=(CholeskyFactor&&) noexcept = default;

Eigen::MatrixXd CholeskyFactor::solve(const Eigen::MatrixXd& right_hand_side) const {
  const OneThread guard;
  Workspace workspace;  // of this call: CHOLMOD writes to it, and calls may run side by side
  cholmod_dense b{};
  b.nrow = b.d = static_cast<std::size_t>(right_hand_side.rows());
  b.ncol = static_cast<std::size_t>(right_hand_side.cols());
  b.nzmax = b.nrow * b.ncol;
  b.x = const_cast<double*>(right_hand_side.data());
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* x = cholmod_solve(CHOLMOD_A, data_->factor, &b, &workspace.common);
  if (x == nullptr) throw SolverError("the triangular solution failed: out of memory");
  Eigen::MatrixXd result = Eigen::Map<const Eigen::MatrixXd>(
      static_cast<const double*>(x->x), right_hand_side.rows(), right_hand_side.cols());
  cholmod_free_dense(&x, &workspace.common);
  return result;
}

double CholeskyFactor::nonzeros() const { return static_cast<double>(data_->factor->xsize); }

}  // namespace codesign::fem
