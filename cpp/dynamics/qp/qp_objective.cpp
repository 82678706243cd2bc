#include "dynamics/qp/qp_objective.hpp"

#include <algorithm>
#include <cmath>

#include "dynamics/dense_kernels.hpp"

namespace codesign::dynamics {

using Eigen::Index;
using Eigen::VectorXd;

DenseObjective::DenseObjective(int size)
    : factor_(Eigen::MatrixXd::Zero(size, size)), right_side_(VectorXd::Zero(size)) {}

void DenseObjective::set(const Eigen::Ref<const Eigen::MatrixXd>& H,
                         const Eigen::Ref<const VectorXd>& g) {
  hessian_ = H.data();
  stride_ = H.outerStride();
  linear_ = g.data();
}

void DenseObjective::scales(VectorXd& root_diagonal, VectorXd& linear) const {
  for (Index i = 0; i < size(); ++i) {
    root_diagonal[i] = std::sqrt(std::max(hessian_[i * stride_ + i], 0.0));
    linear[i] = std::abs(linear_[i]);
  }
}

void DenseObjective::gradient(const VectorXd& x, VectorXd& result) {
  const int n = size();
  std::copy_n(linear_, n, result.data());
  add_product(hessian_, n, n, static_cast<int>(stride_), x.data(), result.data());
}

bool DenseObjective::minimize(const std::vector<int>& free, VectorXd& x) {
  const int m = static_cast<int>(free.size());
  const int stride = static_cast<int>(factor_.outerStride());
  for (int c = 0; c < m; ++c) {
    const int column = free[static_cast<std::size_t>(c)];
    const double* source = hessian_ + column * stride_;
    double* copy = factor_.data() + c * stride;
    for (int r = c; r < m; ++r) copy[r] = source[free[static_cast<std::size_t>(r)]];
    right_side_[c] = -linear_[column];
  }
  auto next = free.begin();
  for (int i = 0; i < size(); ++i) {
    if (next != free.end() && *next == i) {
      ++next;
      continue;
    }
    if (x[i] == 0.0) continue;
    const double* source = hessian_ + i * stride_;
    for (int r = 0; r < m; ++r) right_side_[r] -= x[i] * source[free[static_cast<std::size_t>(r)]];
  }
  if (!cholesky_in_place(factor_.data(), m, stride)) return false;
  cholesky_solve(factor_.data(), m, stride, right_side_.data());
  for (int r = 0; r < m; ++r) x[free[static_cast<std::size_t>(r)]] = right_side_[r];
  return true;
}

void DenseObjective::solve_free(const std::vector<int>& free, VectorXd& r) {
  cholesky_solve(factor_.data(), static_cast<int>(free.size()),
                 static_cast<int>(factor_.outerStride()), r.data());
}

namespace {

// Rows of the kernels go four at a time.
int whole_registers(int rows) { return (rows + 3) / 4 * 4; }

// Of a task, Σ A_i² / d_i over the free variables, up to which its small system is used.
constexpr double kMostWeight = 1e8;

}  // namespace

TaskObjective::TaskObjective(int tasks, int size)
    : scaled(Eigen::MatrixXd::Zero(whole_registers(tasks), size)),
      offset(VectorXd::Zero(scaled.rows())),
      scaled_linear(VectorXd::Zero(size)),
      unit_(VectorXd::Ones(size)),
      root_(VectorXd::Ones(size)),
      free_columns_(scaled),
      factor_(Eigen::MatrixXd::Zero(scaled.rows(), scaled.rows())),
      full_factor_(Eigen::MatrixXd::Zero(size, size)),
      in_units_(VectorXd::Zero(size)),
      fixed_values_(VectorXd::Zero(scaled.rows())),
      task_values_(fixed_values_) {}

void TaskObjective::set_damping(const Eigen::Ref<const VectorXd>& d) {
  root_ = d.cwiseSqrt();
  unit_ = root_.cwiseInverse();
}

Eigen::MatrixXd TaskObjective::hessian() const {
  const Index n = size();
  Eigen::MatrixXd H = Eigen::MatrixXd::Identity(n, n);
  add_outer_product(H.data(), size(), size(), Eigen::MatrixXd(scaled.transpose()).data(), rows(),
                    size(), 1.0);
  H = (root_.asDiagonal() * H * root_.asDiagonal()).eval();
  H.triangularView<Eigen::StrictlyUpper>() = H.transpose();
  return H;
}

VectorXd TaskObjective::linear() const {
  return root_.cwiseProduct(scaled_linear + scaled.transpose() * offset);
}

void TaskObjective::scales(VectorXd& root_diagonal, VectorXd& linear) const {
  linear = scaled_linear;
  add_transposed_product(scaled.data(), rows(), size(), rows(), offset.data(), linear.data());
  for (Index i = 0; i < size(); ++i) {
    root_diagonal[i] = root_[i] * std::sqrt(1.0 + scaled.col(i).squaredNorm());
    linear[i] = root_[i] * std::abs(linear[i]);
  }
}

void TaskObjective::gradient(const VectorXd& x, VectorXd& result) {
  in_units_ = root_.cwiseProduct(x);
  task_values_ = offset;
  add_product(scaled.data(), rows(), size(), rows(), in_units_.data(), task_values_.data());
  result = in_units_ + scaled_linear;
  add_transposed_product(scaled.data(), rows(), size(), rows(), task_values_.data(), result.data());
  result = root_.cwiseProduct(result);
}

bool TaskObjective::minimize(const std::vector<int>& free, VectorXd& x) {
  const int m = static_cast<int>(free.size()), k = rows();
  in_units_ = root_.cwiseProduct(x);
  for (const int i : free) in_units_[i] = 0.0;
  fixed_values_ = offset;
  add_product(scaled.data(), k, size(), k, in_units_.data(), fixed_values_.data());
  for (int c = 0; c < m && m < size(); ++c) {
    free_columns_.col(c) = scaled.col(free[static_cast<std::size_t>(c)]);
  }
  if (!factor(m)) return false;
  for (int c = 0; c < m; ++c) in_units_[c] = -scaled_linear[free[static_cast<std::size_t>(c)]];
  solve(m, fixed_values_.data());
  for (int c = 0; c < m; ++c) {
    const auto i = static_cast<Index>(free[static_cast<std::size_t>(c)]);
    x[i] = unit_[i] * in_units_[c];
  }
  return true;
}

// Of the first m columns: the small system, or H itself where that is no larger or where the tasks
// outweigh the diagonal so much that the small system's rounding would be seen.
bool TaskObjective::factor(int m) {
  const int k = rows();
  if (m > k) {
    factor_.setIdentity();
    add_outer_product(factor_.data(), k, k, columns(m), m, k, 1.0);
    by_tasks_ = factor_.diagonal().maxCoeff() < kMostWeight;
    if (by_tasks_) return cholesky_in_place(factor_.data(), k, k);
  }
  by_tasks_ = false;
  const Eigen::Map<const Eigen::MatrixXd> A(columns(m), k, m);
  full_factor_.topLeftCorner(m, m).noalias() = A.transpose() * A;
  full_factor_.diagonal().array() += 1.0;
  return cholesky_in_place(full_factor_.data(), m, size());
}

// The first entries of in_units_, r, become H⁻¹ (r − Aᵀ values) for the factored columns, in units
// of 1 / √d.
void TaskObjective::solve(int m, const double* values) {
  const int k = rows();
  if (by_tasks_) {
    std::copy_n(values, k, task_values_.data());
    add_product(columns(m), k, m, k, in_units_.data(), task_values_.data());
    cholesky_solve(factor_.data(), k, k, task_values_.data());
    task_values_ = -task_values_;
    add_transposed_product(columns(m), k, m, k, task_values_.data(), in_units_.data());
  } else {
    for (Index i = 0; i < k; ++i) task_values_[i] = -values[i];
    add_transposed_product(columns(m), k, m, k, task_values_.data(), in_units_.data());
    cholesky_solve(full_factor_.data(), m, size(), in_units_.data());
  }
}

void TaskObjective::solve_free(const std::vector<int>& free, VectorXd& r) {
  const int m = static_cast<int>(free.size());
  for (int c = 0; c < m; ++c) in_units_[c] = unit_[free[static_cast<std::size_t>(c)]] * r[c];
  fixed_values_.setZero();
  solve(m, fixed_values_.data());
  for (int c = 0; c < m; ++c) r[c] = unit_[free[static_cast<std::size_t>(c)]] * in_units_[c];
}

}  // namespace codesign::dynamics
