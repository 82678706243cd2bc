#include "fem/meshing/feature_curve.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace codesign::fem {

using Eigen::Vector3d;

std::size_t FeatureCurve::KeyHash::operator()(const Key& key) const {
  std::uint64_t h = 0;
  for (const double x : {key.x, key.y, key.z})
    h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15ull;
  return static_cast<std::size_t>(h ^ (h >> 32));
}

FeatureCurve::FeatureCurve(std::vector<Vector3d> points) : points_(std::move(points)) {
  arc_.push_back(0.0);
  for (std::size_t i = 1; i < points_.size(); ++i)
    arc_.push_back(arc_.back() + (points_[i] - points_[i - 1]).norm());
  for (std::size_t i = 0; i < points_.size(); ++i)  // of a closed curve, the start wins
    known_.try_emplace(Key{points_[i].x(), points_[i].y(), points_[i].z()}, arc_[i]);
}

std::size_t FeatureCurve::segment(double arc) const {
  const auto at = std::upper_bound(arc_.begin(), arc_.end(), arc);
  const auto i = static_cast<std::size_t>(at - arc_.begin());
  return std::clamp<std::size_t>(i, 1, arc_.size() - 1) - 1;
}

Vector3d FeatureCurve::at(double arc) const {
  const std::size_t i = segment(arc);
  const double span = arc_[i + 1] - arc_[i];
  const double s = span > 0.0 ? std::clamp((arc - arc_[i]) / span, 0.0, 1.0) : 0.0;
  if (s == 0.0) return points_[i];
  if (s == 1.0) return points_[i + 1];
  return points_[i] + s * (points_[i + 1] - points_[i]);
}

double FeatureCurve::nearest_position(const Vector3d& p) const {
  double best = 0.0, distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
    const Vector3d d = points_[i + 1] - points_[i];
    const double length2 = d.squaredNorm();
    const double s = length2 > 0.0 ? std::clamp((p - points_[i]).dot(d) / length2, 0.0, 1.0) : 0.0;
    const double d2 = (points_[i] + s * d - p).squaredNorm();
    if (d2 < distance) {
      distance = d2;
      best = arc_[i] + s * (arc_[i + 1] - arc_[i]);
    }
  }
  return best;
}

Vector3d FeatureCurve::nearest(const Vector3d& p) const { return at(nearest_position(p)); }

double FeatureCurve::position(const Vector3d& p) const {
  const auto [known, fresh] = known_.try_emplace(Key{p.x(), p.y(), p.z()}, 0.0);
  if (fresh) known->second = nearest_position(p);
  return known->second;
}

double FeatureCurve::length_between(const Vector3d& p, const Vector3d& q, bool forward) const {
  const double step = forward ? position(q) - position(p) : position(p) - position(q);
  if (!is_closed()) return std::abs(step);
  return step < 0.0 ? step + length() : step;
}

Vector3d FeatureCurve::point_at(const Vector3d& p, double distance) const {
  double arc = position(p) + distance;
  if (is_closed()) {
    if (arc < 0.0) arc += length();
    if (arc >= length()) arc -= length();
  }
  arc = std::clamp(arc, 0.0, length());
  const Vector3d point = at(arc);
  known_.try_emplace(Key{point.x(), point.y(), point.z()}, arc);
  return point;
}

namespace {

// Where the line a + s (b - a) is inside a ball: the interval of s, empty as (1, 0).
std::pair<double, double> inside_ball(const Vector3d& a, const Vector3d& b, const Vector3d& center,
                                      double squared_radius) {
  const Vector3d d = b - a, m = a - center;
  const double dd = d.squaredNorm(), md = m.dot(d), c = m.squaredNorm() - squared_radius;
  const double discriminant = md * md - dd * c;
  if (dd == 0.0) return c <= 0.0 ? std::pair{0.0, 1.0} : std::pair{1.0, 0.0};
  if (discriminant < 0.0) return {1.0, 0.0};
  const double root = std::sqrt(discriminant);
  return {(-md - root) / dd, (-md + root) / dd};
}

}  // namespace

bool FeatureCurve::is_covered(const Vector3d& p, double squared_radius_p, const Vector3d& q,
                              double squared_radius_q, bool forward) const {
  const Vector3d& from = forward ? p : q;
  const Vector3d& to = forward ? q : p;
  const double radius_from = forward ? squared_radius_p : squared_radius_q;
  const double radius_to = forward ? squared_radius_q : squared_radius_p;
  double arc = position(from);
  double end = position(to);
  if (is_closed() && end <= arc) end += length();
  Vector3d a = from;
  while (arc < end) {
    const bool wrapped = arc >= length();
    const std::size_t i = segment(wrapped ? arc - length() : arc);
    const double next = std::min(end, arc_[i + 1] + (wrapped ? length() : 0.0));
    const Vector3d b = next < end ? points_[i + 1] : to;
    const auto [s0, s1] = inside_ball(a, b, from, radius_from);
    const auto [t0, t1] = inside_ball(a, b, to, radius_to);
    const bool by_from = s0 <= 0.0 && s1 >= 1.0, by_to = t0 <= 0.0 && t1 >= 1.0;
    const bool by_both =
        (s0 <= 0.0 && s1 >= t0 && t1 >= 1.0) || (t0 <= 0.0 && t1 >= s0 && s1 >= 1.0);
    if (!by_from && !by_to && !by_both) return false;
    if (!(next > arc)) return true;  // a step too short for its length to be counted
    arc = next;
    a = b;
  }
  return true;
}

}  // namespace codesign::fem
