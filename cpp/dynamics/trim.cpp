#include "dynamics/trim.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <limits>
#include <stdexcept>

#include "dynamics/robot_terms.hpp"

namespace codesign::dynamics {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

void require(bool holds, const std::string& reason) {
  if (!holds) throw std::invalid_argument("trim_hover: " + reason);
}

// The unknowns x = (moving joints, tilt about the world's x and y, thrusts), each with its range
// and its share in what is least.
class HoverTrim {
 public:
  HoverTrim(const Model& model, const std::vector<Actuator>& actuators, const Pose& base,
            const VectorXd& joints, const JointRanges& ranges, const TrimSettings& settings);
  Trim solve();

 private:
  void set_state();
  void linearize();
  VectorXd step() const;

  Index tilt() const { return static_cast<Index>(moving_.size()); }
  Index thrust() const { return tilt() + 2; }

  const Model& model_;
  const TrimSettings& settings_;
  Pose base_;  // the wanted one
  std::vector<Index> moving_;
  RobotTerms terms_;
  RobotState state_;
  VectorXd wanted_, weight_, lower_, upper_, x_;
  Vector6d residual_;
  MatrixXd jacobian_;  // (6, unknowns)
};

HoverTrim::HoverTrim(const Model& model, const std::vector<Actuator>& actuators, const Pose& base,
                     const VectorXd& joints, const JointRanges& ranges,
                     const TrimSettings& settings)
    : model_(model), settings_(settings), base_(base), terms_(model, actuators) {
  state_ = {base, joints.cwiseMax(ranges.lower).cwiseMin(ranges.upper),
            VectorXd::Zero(model.dofs())};
  for (const std::string& name : settings.joints) moving_.push_back(joint_index(model, name));
  // A joint that is held keeps its angle, also outside of its range.
  for (Index j = 0; j < joints.size(); ++j) {
    if (std::find(moving_.begin(), moving_.end(), j) == moving_.end()) state_.joints[j] = joints[j];
  }
  const auto jets = static_cast<Index>(actuators.size());
  const Index size = thrust() + jets;
  wanted_.setZero(size);
  weight_.setOnes(size);
  lower_.setConstant(size, -std::numeric_limits<double>::infinity());
  upper_ = -lower_;
  for (Index i = 0; i < tilt(); ++i) {
    const Index joint = moving_[static_cast<std::size_t>(i)];
    wanted_[i] = state_.joints[joint];
    lower_[i] = ranges.lower[joint];
    upper_[i] = ranges.upper[joint];
  }
  weight_.segment<2>(tilt()).setConstant(settings.tilt_weight);
  weight_.tail(jets).setConstant(settings.thrust_weight);
  for (Index i = 0; i < jets; ++i) {
    const Actuator& actuator = actuators[static_cast<std::size_t>(i)];
    lower_[thrust() + i] = actuator.thrust_min;
    upper_[thrust() + i] = actuator.thrust_max;
  }
  wanted_.tail(jets).setConstant(model.total_mass * kGravity / static_cast<double>(jets));
  x_ = wanted_.cwiseMax(lower_).cwiseMin(upper_);
  jacobian_.setZero(6, size);
}

void HoverTrim::set_state() {
  for (Index i = 0; i < tilt(); ++i) state_.joints[moving_[static_cast<std::size_t>(i)]] = x_[i];
  state_.base.R = exp_so3({x_[tilt()], x_[tilt() + 1], 0.0}) * base_.R;
  update_terms(model_, state_, terms_);
}

// The balance A T − (m g e₃; 0) at x and its derivatives.
void HoverTrim::linearize() {
  const Index jets = x_.size() - thrust();
  const VectorXd thrusts = x_.tail(jets);
  Matrix6Xd A(6, jets), rate(6, model_.dofs());
  jet_map(terms_, A);
  jet_map_rate(model_, terms_, thrusts, rate);
  const Vector6d wrench = A * thrusts;
  residual_ = wrench;
  residual_[2] -= terms_.robot.mass * kGravity;
  for (Index i = 0; i < tilt(); ++i) {
    jacobian_.col(i) = rate.col(kBaseDofs + moving_[static_cast<std::size_t>(i)]);
  }
  // All forces turn with the base. A change of the rotation vector t turns it by (1 + S(t)/2) dt,
  // to first order in t.
  const Vector3d t(x_[tilt()], x_[tilt() + 1], 0.0);
  for (int axis = 0; axis < 2; ++axis) {
    const Vector3d unit = Vector3d::Unit(axis);
    const Vector3d turn = unit + 0.5 * t.cross(unit);
    jacobian_.col(tilt() + axis) << turn.cross(wrench.head<3>()), turn.cross(wrench.tail<3>());
  }
  jacobian_.rightCols(jets) = A;
}

// To the least weighted distance from the wanted state on the linearized balance. What would leave
// its range goes to the range's end and stays there while the others are solved for again.
VectorXd HoverTrim::step() const {
  VectorXd change = VectorXd::Zero(x_.size());
  std::vector<Index> free(static_cast<std::size_t>(x_.size()));
  for (std::size_t i = 0; i < free.size(); ++i) free[i] = static_cast<Index>(i);
  Vector6d rest = -residual_;
  while (!free.empty()) {
    const auto count = static_cast<Index>(free.size());
    MatrixXd scaled(6, count);
    VectorXd back(count);  // towards the wanted state, weighted
    Vector6d right = rest;
    for (Index i = 0; i < count; ++i) {
      const Index u = free[static_cast<std::size_t>(i)];
      scaled.col(i) = jacobian_.col(u) / weight_[u];
      back[i] = weight_[u] * (wanted_[u] - x_[u]);
    }
    right -= scaled * back;
    const VectorXd solution = back + scaled.completeOrthogonalDecomposition().solve(right);
    std::vector<Index> inside;
    for (Index i = 0; i < count; ++i) {
      const Index u = free[static_cast<std::size_t>(i)];
      const double wish = x_[u] + solution[i] / weight_[u];
      change[u] = std::clamp(wish, lower_[u], upper_[u]) - x_[u];
      if (wish >= lower_[u] && wish <= upper_[u]) {
        inside.push_back(u);
      } else {
        rest -= jacobian_.col(u) * change[u];
      }
    }
    if (inside.size() == free.size()) break;
    free = std::move(inside);
  }
  return change;
}

Trim HoverTrim::solve() {
  Trim trim;
  const Index jets = x_.size() - thrust();
  for (; trim.iterations < settings_.iterations; ++trim.iterations) {
    set_state();
    linearize();
    VectorXd change = step();
    const double farthest = tilt() > 0 ? change.head(tilt()).lpNorm<Eigen::Infinity>() : 0.0;
    if (farthest > settings_.largest_step) change *= settings_.largest_step / farthest;
    // As exact as the balance: rounding of the angles moves it by less than its tolerance.
    constexpr double kStill = 1e-10;
    const bool still = change.cwiseProduct(weight_).lpNorm<Eigen::Infinity>() < kStill;
    if (still && residual_.lpNorm<Eigen::Infinity>() <= settings_.tolerance) break;
    x_ += change;
    wanted_.tail(jets).setConstant(x_.tail(jets).mean());
  }
  set_state();
  linearize();
  trim.base = state_.base;
  trim.joints = state_.joints;
  trim.thrusts = x_.tail(jets);
  trim.residual = residual_.lpNorm<Eigen::Infinity>();
  trim.reached = trim.residual <= settings_.tolerance;
  return trim;
}

}  // namespace

Trim trim_hover(const Model& model, const std::vector<Actuator>& actuators, const Pose& base,
                const Eigen::Ref<const VectorXd>& joints, const JointRanges& ranges,
                const TrimSettings& settings) {
  const Index n = model.joint_count();
  require(!model.fixed_base, "the model's base is fixed");
  require(!actuators.empty(), "there are no actuators");
  require(joints.size() == n && ranges.lower.size() == n && ranges.upper.size() == n,
          "joints and both ends of their ranges must have one value per joint of the model (" +
              std::to_string(n) + ")");
  require(joints.allFinite(), "joints has a value that is not finite");
  require((ranges.lower.array() < ranges.upper.array()).all(), "the range of a joint is empty");
  require(settings.tilt_weight > 0.0 && settings.thrust_weight > 0.0 &&
              settings.largest_step > 0.0 && settings.tolerance > 0.0 && settings.iterations > 0,
          "weights, largest_step, tolerance and iterations must be positive");
  return HoverTrim(model, actuators, base, joints, ranges, settings).solve();
}

}  // namespace codesign::dynamics
