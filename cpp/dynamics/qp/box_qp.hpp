#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/qp/qp_objective.hpp"

namespace codesign::dynamics {

// A strictly convex quadratic program with bounds only:
//   minimize ½ xᵀHx + gᵀx   subject to   lower ≤ x ≤ upper.
// At the solution Hx + g = multipliers, with multipliers ≥ 0 where x = lower, ≤ 0 where x = upper,
// of either sign where lower = upper, and 0 elsewhere. What it does not do: general constraints,
// semidefinite Hessians.
enum class QpStatus {
  kSolved,               // KKT residual at most kQpTolerance
  kIterationLimit,       // best point found is returned; its KKT residual is above the tolerance
  kNotPositiveDefinite,  // a Cholesky pivot of the Hessian's free block is not positive
  kBadData,              // a value is not a number, or lower > upper
};

// A point counts as solved up to this KKT residual (see BoxQpResult); round-off leaves 1e-15.
inline constexpr double kQpTolerance = 1e-9;

// A solution, or how far the solver came.
struct BoxQpResult {
  QpStatus status = QpStatus::kBadData;
  int iterations = 0;  // changes of the working set plus one: the number of Cholesky factorizations
  // Largest violation of the conditions above over i, each divided by
  // √H_ii Σ_j √H_jj |x_j| + |g_i|: dimensionless, and independent of the variables' units.
  double kkt_residual = 0.0;
  Eigen::VectorXd x;
  Eigen::VectorXd multipliers;
};

// Solver for problems of one size. Starts from the working set of its last solution; allocates only
// in the constructor.
//
// Method: exchange of all violated bounds at once (block principal pivoting: Júdice and Pires,
// 1994, "A block principal pivoting algorithm for large-scale strictly monotone linear
// complementarity problems") as long as their number falls, which settles almost every problem in a
// few Cholesky factorizations; otherwise a primal active-set descent (Nocedal and Wright, Numerical
// Optimization, §16.5), one bound at a time, whose objective falls strictly between changes of the
// working set, so that it cannot cycle in exact arithmetic; its iterations are bounded as well.
class BoxQpSolver {
 public:
  explicit BoxQpSolver(int size);  // throws std::invalid_argument if size < 1

  int size() const { return static_cast<int>(result_.x.size()); }
  const BoxQpResult& result() const { return result_; }  // of the last call

  // H is (n, n) symmetric (both triangles filled), the others (n,); bounds may be ±infinity.
  // The result stays valid until the next call. Throws std::invalid_argument on a wrong size.
  const BoxQpResult& solve(const Eigen::Ref<const Eigen::MatrixXd>& H,
                           const Eigen::Ref<const Eigen::VectorXd>& g,
                           const Eigen::Ref<const Eigen::VectorXd>& lower,
                           const Eigen::Ref<const Eigen::VectorXd>& upper);

  // The same of an objective with a structure.
  const BoxQpResult& solve(QpObjective& objective, const Eigen::Ref<const Eigen::VectorXd>& lower,
                           const Eigen::Ref<const Eigen::VectorXd>& upper);

  void reset();  // forget the last working set: the next call starts with every variable free

 private:
  enum class Place : signed char { kFree, kLower, kUpper, kFixed };
  struct Problem;

  bool prepare(const Problem& p);
  bool minimize_on_free_set(const Problem& p, Eigen::VectorXd& target);
  void refine(const Problem& p);
  void update_gradient(const Problem& p);
  double residual() const;
  QpStatus exchange_blocks(const Problem& p);
  QpStatus descend(const Problem& p);
  int step_towards_target(const Problem& p, double& length);
  int most_violated_multiplier() const;
  double tolerance(int i) const;

  std::vector<Place> place_;   // where each variable is held: the working set
  std::vector<Place> wanted_;  // the next working set, while bounds are exchanged
  std::vector<int> free_;      // indices of the free variables, ascending
  DenseObjective dense_;
  Eigen::VectorXd free_solution_;   // right-hand side and solution of a refinement
  Eigen::VectorXd target_;          // minimizer on the current free set, all variables
  Eigen::VectorXd gradient_;        // Hx + g
  Eigen::VectorXd root_diagonal_;   // √H_ii
  Eigen::VectorXd linear_size_;     // |g_i|
  Eigen::VectorXd gradient_scale_;  // what the entries of the gradient are measured against
  BoxQpResult result_;
};

}  // namespace codesign::dynamics
