#include "dynamics/waypoints.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace codesign::dynamics {

using Eigen::Index;
using Eigen::Vector4d;

namespace {

constexpr int kTerms = 6;  // of a quintic polynomial

using Row = Eigen::Matrix<double, 1, kTerms>;

// Derivative `order` of the monomials x^k at x in [0, 1], with respect to x.
Row monomials(int order, double x) {
  Row row = Row::Zero();
  for (int k = order; k < kTerms; ++k) {
    double factor = 1.0;
    for (int i = 0; i < order; ++i) factor *= k - i;
    row[k] = factor * std::pow(x, k - order);
  }
  return row;
}

Vector4d knot(const Waypoint& w) { return {w.position.x(), w.position.y(), w.position.z(), w.yaw}; }

void require_valid(const WaypointPath& path) {
  const auto refuse = [](const char* reason) {
    throw std::invalid_argument(std::string("waypoints: ") + reason);
  };
  if (!(path.start >= 0.0) || !std::isfinite(path.start)) refuse("start is negative or not finite");
  for (const Waypoint& w : path.waypoints) {
    if (!knot(w).allFinite()) refuse("a position or yaw is not finite");
    if (!(w.duration > 0.0) || !std::isfinite(w.duration)) refuse("a duration is not positive");
    if (!(w.rest >= 0.0) || !std::isfinite(w.rest)) refuse("a rest is negative or not finite");
  }
}

}  // namespace

Path::Path(const WaypointPath& path) {
  require_valid(path);
  double start = path.start;
  Vector4d from = Vector4d::Zero();
  for (std::size_t first = 0; first < path.waypoints.size();) {
    // A piece between two rests: one leg, or up to the next way-point with a rest.
    std::size_t last = first;
    if (path.kind == WaypointKind::kThrough) {
      while (last + 1 < path.waypoints.size() && path.waypoints[last].rest == 0.0) ++last;
    }
    const auto count = static_cast<Index>(last - first + 1);
    Eigen::Matrix<double, 4, Eigen::Dynamic> knots(4, count + 1);
    std::vector<double> durations;
    knots.col(0) = from;
    for (Index i = 0; i < count; ++i) {
      const Waypoint& w = path.waypoints[first + static_cast<std::size_t>(i)];
      knots.col(i + 1) = knot(w);
      durations.push_back(w.duration);
    }
    add_spline(knots, durations, start);
    for (const double duration : durations) start += duration;
    start += path.waypoints[last].rest;
    from = knots.col(count);
    first = last + 1;
  }
  last_ = from;
  end_ = start;
}

// The quintic spline of least squared jerk: values at the knots, four continuous derivatives
// between legs, no velocity and acceleration at the ends. A single leg is the minimum-jerk one.
void Path::add_spline(const Eigen::Matrix<double, 4, Eigen::Dynamic>& knots,
                      const std::vector<double>& durations, double start) {
  const auto legs = static_cast<Index>(durations.size());
  const Index n = kTerms * legs;
  Eigen::MatrixXd equations = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(n, 4);
  Index row = 0;
  for (int order = 1; order <= 2; ++order) {
    equations.block<1, kTerms>(row++, 0) = monomials(order, 0.0);
    equations.block<1, kTerms>(row++, n - kTerms) = monomials(order, 1.0);
  }
  for (Index leg = 0; leg < legs; ++leg) {
    for (int end = 0; end <= 1; ++end) {
      equations.block<1, kTerms>(row, kTerms * leg) = monomials(0, end);
      values.row(row++) = knots.col(leg + end).transpose();
    }
    if (leg + 1 == legs) break;
    // In units of the leg's own duration, so that no row is large beside another.
    const double ratio =
        durations[static_cast<std::size_t>(leg)] / durations[static_cast<std::size_t>(leg) + 1];
    for (int order = 1; order <= 4; ++order) {
      equations.block<1, kTerms>(row, kTerms * leg) = monomials(order, 1.0);
      equations.block<1, kTerms>(row++, kTerms * (leg + 1)) =
          -std::pow(ratio, order) * monomials(order, 0.0);
    }
  }
  const Eigen::MatrixXd solution = equations.partialPivLu().solve(values);
  for (Index leg = 0; leg < legs; ++leg) {
    const double duration = durations[static_cast<std::size_t>(leg)];
    legs_.push_back({start, duration, solution.middleRows<kTerms>(kTerms * leg).transpose()});
    start += duration;
  }
}

PathPoint Path::at(double time) const {
  PathPoint point;
  const Leg* leg = nullptr;
  for (const Leg& candidate : legs_) {
    if (time < candidate.start) break;
    leg = &candidate;
  }
  if (leg == nullptr) return point;
  const double x = (time - leg->start) / leg->duration;
  if (x >= 1.0) {
    point.value = leg->coefficients.rowwise().sum();
    if (leg == &legs_.back()) point.value = last_;
    return point;
  }
  const double rate = 1.0 / leg->duration;
  point.value = leg->coefficients * monomials(0, x).transpose();
  point.velocity = rate * (leg->coefficients * monomials(1, x).transpose());
  point.acceleration = rate * rate * (leg->coefficients * monomials(2, x).transpose());
  point.jerk = rate * rate * rate * (leg->coefficients * monomials(3, x).transpose());
  return point;
}

double Path::peak(Vector4d PathPoint::*derivative) const {
  constexpr int kSamples = 100;
  double largest = 0.0;
  for (const Leg& leg : legs_) {
    for (int i = 0; i < kSamples; ++i) {
      const PathPoint point = at(leg.start + leg.duration * i / kSamples);
      largest = std::max(largest, (point.*derivative).head<3>().norm());
    }
  }
  return largest;
}

double Path::peak_speed() const { return peak(&PathPoint::velocity); }
double Path::peak_acceleration() const { return peak(&PathPoint::acceleration); }

}  // namespace codesign::dynamics
