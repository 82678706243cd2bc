#pragma once

#include <Eigen/Core>
#include <vector>

// Objectives ½ xᵀHx + gᵀx of box QPs (box_qp.hpp), H positive definite, each with the operations
// that its structure makes cheap. Nothing allocates but the constructors.
namespace codesign::dynamics {

// What the solver asks of an objective of size() unknowns.
class QpObjective {
 public:
  virtual ~QpObjective() = default;
  virtual int size() const = 0;

  // √H_ii and |g_i|.
  virtual void scales(Eigen::VectorXd& root_diagonal, Eigen::VectorXd& linear) const = 0;

  // Hx + g.
  virtual void gradient(const Eigen::VectorXd& x, Eigen::VectorXd& result) = 0;

  // Of the variables in `free` (ascending) the minimizer, while the others stay. False if H is not
  // positive definite on them.
  virtual bool minimize(const std::vector<int>& free, Eigen::VectorXd& x) = 0;

  // The first entries of r, one per variable of the last minimize(), become H⁻¹ r on these.
  virtual void solve_free(const std::vector<int>& free, Eigen::VectorXd& r) = 0;
};

// H and g as they are.
class DenseObjective final : public QpObjective {
 public:
  explicit DenseObjective(int size);

  // H (n, n), both triangles filled, and g (n,) must stay until the last call of the others.
  void set(const Eigen::Ref<const Eigen::MatrixXd>& H, const Eigen::Ref<const Eigen::VectorXd>& g);

  int size() const override { return static_cast<int>(right_side_.size()); }
  void scales(Eigen::VectorXd& root_diagonal, Eigen::VectorXd& linear) const override;
  void gradient(const Eigen::VectorXd& x, Eigen::VectorXd& result) override;
  bool minimize(const std::vector<int>& free, Eigen::VectorXd& x) override;
  void solve_free(const std::vector<int>& free, Eigen::VectorXd& r) override;

 private:
  const double* hessian_ = nullptr;
  Eigen::Index stride_ = 0;
  const double* linear_ = nullptr;
  Eigen::MatrixXd factor_;  // Cholesky factor of the free block, lower triangle
  Eigen::VectorXd right_side_;
};

// A few weighted tasks and a diagonal: ½ |A x + offset|² + ½ Σ dᵢ xᵢ² + linearᵀ x, d > 0. With
// fewer tasks than variables its minimizer is that of a small system: for z = A x + offset,
//   (I + A_F D_F⁻¹ A_Fᵀ) z = offset + A_B x_B − A_F D_F⁻¹ linear_F,  x_F = −D_F⁻¹ (linear_F + A_Fᵀ
//   z),
// F the free variables and B the others (Woodbury's identity, without its cancellation).
class TaskObjective final : public QpObjective {
 public:
  TaskObjective(int tasks, int size);

  // What the next calls are about. `scaled`: row k of column i is A_ki / √dᵢ; rows after the last
  // task stay zero. `scaled_linear`: linearᵢ / √dᵢ.
  Eigen::MatrixXd scaled;
  Eigen::VectorXd offset, scaled_linear;
  void set_damping(const Eigen::Ref<const Eigen::VectorXd>& d);  // (n,)
  const Eigen::VectorXd& unit() const { return unit_; }          // 1 / √d

  Eigen::MatrixXd hessian() const;  // H (n, n)
  Eigen::VectorXd linear() const;   // g (n,)

  int size() const override { return static_cast<int>(unit_.size()); }
  void scales(Eigen::VectorXd& root_diagonal, Eigen::VectorXd& linear) const override;
  void gradient(const Eigen::VectorXd& x, Eigen::VectorXd& result) override;
  bool minimize(const std::vector<int>& free, Eigen::VectorXd& x) override;
  void solve_free(const std::vector<int>& free, Eigen::VectorXd& r) override;

 private:
  bool factor(int m);
  void solve(int m, const double* values);
  // Of `scaled`, those of the m free variables.
  const double* columns(int m) const { return m < size() ? free_columns_.data() : scaled.data(); }
  int rows() const { return static_cast<int>(scaled.rows()); }

  Eigen::VectorXd unit_, root_;  // 1 / √d, √d
  Eigen::MatrixXd free_columns_;
  bool by_tasks_ = false;
  Eigen::MatrixXd factor_;       // of the small system
  Eigen::MatrixXd full_factor_;  // of H on the free variables, instead
  Eigen::VectorXd in_units_, fixed_values_, task_values_;
};

}  // namespace codesign::dynamics
