#include "dynamics/qp/box_qp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace codesign::dynamics {

namespace {

// A multiplier of the wrong sign counts as zero up to this fraction of the gradient's scale:
// somewhat above the round-off of the gradient itself.
constexpr double kMultiplierTolerance = 1e-13;

// Above this residual the solution of the free block is refined once with its own factor.
constexpr double kRefineAbove = 1e-14;

}  // namespace

struct BoxQpSolver::Problem {
  QpObjective& objective;
  const Eigen::Ref<const Eigen::VectorXd>& lower;
  const Eigen::Ref<const Eigen::VectorXd>& upper;
};

namespace {

int checked(int size) {
  if (size >= 0) return size;
  throw std::invalid_argument("BoxQpSolver: size is " + std::to_string(size) + ", must be >= 0");
}

}  // namespace

BoxQpSolver::BoxQpSolver(int size) : dense_(checked(size)) {
  place_.assign(static_cast<std::size_t>(size), Place::kFree);
  wanted_ = place_;
  free_.reserve(place_.size());
  for (Eigen::VectorXd* v : {&free_solution_, &target_, &gradient_, &root_diagonal_, &linear_size_,
                             &gradient_scale_, &result_.x, &result_.multipliers}) {
    v->setZero(size);
  }
}

void BoxQpSolver::reset() { std::fill(place_.begin(), place_.end(), Place::kFree); }

const BoxQpResult& BoxQpSolver::solve(const Eigen::Ref<const Eigen::MatrixXd>& H,
                                      const Eigen::Ref<const Eigen::VectorXd>& g,
                                      const Eigen::Ref<const Eigen::VectorXd>& lower,
                                      const Eigen::Ref<const Eigen::VectorXd>& upper) {
  const Eigen::Index n = result_.x.size();
  if (H.rows() != n || H.cols() != n || g.size() != n) {
    throw std::invalid_argument("BoxQpSolver: H and g must have size " + std::to_string(n));
  }
  dense_.set(H, g);
  return solve(dense_, lower, upper);
}

const BoxQpResult& BoxQpSolver::solve(QpObjective& objective,
                                      const Eigen::Ref<const Eigen::VectorXd>& lower,
                                      const Eigen::Ref<const Eigen::VectorXd>& upper) {
  const Eigen::Index n = result_.x.size();
  if (objective.size() != n || lower.size() != n || upper.size() != n) {
    throw std::invalid_argument("BoxQpSolver: objective, lower and upper must have size " +
                                std::to_string(n));
  }
  const Problem p{objective, lower, upper};
  result_.iterations = 0;
  result_.kkt_residual = 0.0;
  if (n == 0) {  // of a robot without joints
    result_.status = QpStatus::kSolved;
    return result_;
  }
  if (!prepare(p)) {
    result_.status = QpStatus::kBadData;
    return result_;
  }
  result_.status = exchange_blocks(p);
  if (result_.status == QpStatus::kIterationLimit) result_.status = descend(p);
  if (result_.status == QpStatus::kNotPositiveDefinite) return result_;

  result_.kkt_residual = residual();
  if (result_.kkt_residual > kRefineAbove) refine(p);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Place place = place_[static_cast<std::size_t>(i)];
    result_.multipliers[i] = place == Place::kFree    ? 0.0
                             : place == Place::kLower ? std::max(gradient_[i], 0.0)
                             : place == Place::kUpper ? std::min(gradient_[i], 0.0)
                                                      : gradient_[i];
  }
  if (std::isnan(result_.kkt_residual)) {
    result_.status = QpStatus::kBadData;
  } else {
    result_.status =
        result_.kkt_residual <= kQpTolerance ? QpStatus::kSolved : QpStatus::kIterationLimit;
  }
  return result_;
}

// Scales, and the working set of the last call made valid for the new bounds.
bool BoxQpSolver::prepare(const Problem& p) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  p.objective.scales(root_diagonal_, linear_size_);
  for (Eigen::Index i = 0; i < size(); ++i) {
    const double low = p.lower[i];
    const double high = p.upper[i];
    if (!(low <= high) || low == kInfinity || high == -kInfinity || std::isnan(linear_size_[i])) {
      return false;
    }
    Place& place = place_[static_cast<std::size_t>(i)];
    if (low == high) {
      place = Place::kFixed;
    } else if (place == Place::kFixed || (place == Place::kLower && low == -kInfinity) ||
               (place == Place::kUpper && high == kInfinity)) {
      place = Place::kFree;
    }
  }
  return true;
}

// Puts the minimizer over the free variables, the others on their bounds, into `target`.
bool BoxQpSolver::minimize_on_free_set(const Problem& p, Eigen::VectorXd& target) {
  ++result_.iterations;
  const int n = size();
  free_.clear();
  for (int i = 0; i < n; ++i) {
    const Place place = place_[static_cast<std::size_t>(i)];
    if (place == Place::kFree) {
      free_.push_back(i);
    } else {
      target[i] = place == Place::kUpper ? p.upper[i] : p.lower[i];
    }
  }
  return p.objective.minimize(free_, target);
}

void BoxQpSolver::update_gradient(const Problem& p) {
  p.objective.gradient(result_.x, gradient_);
  const double weighted_size = root_diagonal_.dot(result_.x.cwiseAbs());
  gradient_scale_ = root_diagonal_ * weighted_size + linear_size_;
}

double BoxQpSolver::tolerance(int i) const { return kMultiplierTolerance * gradient_scale_[i]; }

double BoxQpSolver::residual() const {
  double worst = 0.0;
  for (int i = 0; i < size(); ++i) {
    const Place place = place_[static_cast<std::size_t>(i)];
    const double y = gradient_[i];
    double violation = 0.0;
    if (place == Place::kFree) violation = std::abs(y);
    if (place == Place::kLower) violation = std::max(-y, 0.0);
    if (place == Place::kUpper) violation = std::max(y, 0.0);
    if (std::isnan(y)) return y;
    if (violation > 0.0) worst = std::max(worst, violation / gradient_scale_[i]);
  }
  return worst;
}

// One step of iterative refinement on the free set, kept if it helps and stays within the bounds.
void BoxQpSolver::refine(const Problem& p) {
  const int m = static_cast<int>(free_.size());
  for (int r = 0; r < m; ++r) free_solution_[r] = -gradient_[free_[static_cast<std::size_t>(r)]];
  p.objective.solve_free(free_, free_solution_);
  target_ = result_.x;
  for (int r = 0; r < m; ++r) {
    const int i = free_[static_cast<std::size_t>(r)];
    result_.x[i] = std::clamp(target_[i] + free_solution_[r], p.lower[i], p.upper[i]);
  }
  update_gradient(p);
  const double refined = residual();
  if (refined < result_.kkt_residual) {
    result_.kkt_residual = refined;
  } else {
    result_.x = target_;
    update_gradient(p);
  }
}

QpStatus BoxQpSolver::exchange_blocks(const Problem& p) {
  int fewest = size() + 1;
  while (true) {
    if (!minimize_on_free_set(p, result_.x)) return QpStatus::kNotPositiveDefinite;
    update_gradient(p);
    int violated = 0;
    for (int i = 0; i < size(); ++i) {
      const std::size_t at = static_cast<std::size_t>(i);
      wanted_[at] = place_[at];
      if (place_[at] == Place::kFree) {
        if (result_.x[i] < p.lower[i]) wanted_[at] = Place::kLower;
        if (result_.x[i] > p.upper[i]) wanted_[at] = Place::kUpper;
      } else if ((place_[at] == Place::kLower && gradient_[i] < -tolerance(i)) ||
                 (place_[at] == Place::kUpper && gradient_[i] > tolerance(i))) {
        wanted_[at] = Place::kFree;
      }
      if (wanted_[at] != place_[at]) ++violated;
    }
    if (violated == 0) return QpStatus::kSolved;
    if (violated >= fewest) return QpStatus::kIterationLimit;
    fewest = violated;
    place_.swap(wanted_);
  }
}

// From the last point pulled into the box. Each pass minimizes on the free set, walks there as far
// as the bounds allow, and takes in the bound that stops it; at a minimum on the free set the bound
// with the most wrong multiplier is let go.
QpStatus BoxQpSolver::descend(const Problem& p) {
  const int n = size();
  for (int i = 0; i < n; ++i) {
    Place& place = place_[static_cast<std::size_t>(i)];
    if (place == Place::kFree && result_.x[i] < p.lower[i]) place = Place::kLower;
    if (place == Place::kFree && result_.x[i] > p.upper[i]) place = Place::kUpper;
    result_.x[i] = std::clamp(result_.x[i], p.lower[i], p.upper[i]);
  }
  const int limit = 50 * (n + 2);
  int released = -1;
  while (result_.iterations < limit) {
    if (!minimize_on_free_set(p, target_)) return QpStatus::kNotPositiveDefinite;
    double length = 1.0;
    const int blocking = step_towards_target(p, length);
    update_gradient(p);
    if (blocking >= 0) {
      // A bound let go for its multiplier and met again at once: the multiplier was round-off.
      if (blocking == released && length == 0.0) return QpStatus::kSolved;
      continue;
    }
    released = most_violated_multiplier();
    if (released < 0) return QpStatus::kSolved;
    place_[static_cast<std::size_t>(released)] = Place::kFree;
  }
  return QpStatus::kIterationLimit;
}

// Moves x towards the target as far as the bounds allow; returns the variable that stopped it,
// placed on its bound, or −1.
int BoxQpSolver::step_towards_target(const Problem& p, double& length) {
  int blocking = -1;
  for (const int i : free_) {
    const double bound = target_[i] < p.lower[i]   ? p.lower[i]
                         : target_[i] > p.upper[i] ? p.upper[i]
                                                   : target_[i];
    if (bound == target_[i]) continue;
    const double reach = (bound - result_.x[i]) / (target_[i] - result_.x[i]);
    if (reach < length || blocking < 0) {
      length = std::clamp(reach, 0.0, 1.0);
      blocking = i;
    }
  }
  if (blocking < 0) {
    result_.x = target_;
    return blocking;
  }
  for (const int i : free_) {
    const double moved = result_.x[i] + length * (target_[i] - result_.x[i]);
    result_.x[i] = std::clamp(moved, p.lower[i], p.upper[i]);
  }
  const bool at_lower = target_[blocking] < p.lower[blocking];
  place_[static_cast<std::size_t>(blocking)] = at_lower ? Place::kLower : Place::kUpper;
  result_.x[blocking] = at_lower ? p.lower[blocking] : p.upper[blocking];
  return blocking;
}

int BoxQpSolver::most_violated_multiplier() const {
  int worst = -1;
  double largest = 0.0;
  for (int i = 0; i < size(); ++i) {
    const Place place = place_[static_cast<std::size_t>(i)];
    const double wrong = place == Place::kLower   ? -gradient_[i]
                         : place == Place::kUpper ? gradient_[i]
                                                  : 0.0;
    if (wrong > tolerance(i) &&
        wrong * root_diagonal_[worst < 0 ? i : worst] > largest * root_diagonal_[i]) {
      largest = wrong;
      worst = i;
    }
  }
  return worst;
}

}  // namespace codesign::dynamics
