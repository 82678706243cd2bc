#include "dynamics/nearest_approach.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "dynamics/convex_distance.hpp"

namespace codesign::dynamics {
namespace {

using Eigen::Vector3d;

constexpr double kRigid = 1e-12;  // [m] and rotation entries: less is no motion

Sphere sphere_around(const PiecewiseConvex::Points* pieces, std::size_t count) {
  Vector3d low = pieces[0].rowwise().minCoeff(), high = pieces[0].rowwise().maxCoeff();
  for (std::size_t k = 1; k < count; ++k) {
    low = low.cwiseMin(pieces[k].rowwise().minCoeff());
    high = high.cwiseMax(pieces[k].rowwise().maxCoeff());
  }
  const Vector3d center = 0.5 * (low + high);
  double squared = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    squared = std::max(squared, (pieces[k].colwise() - center).colwise().squaredNorm().maxCoeff());
  }
  return {center, std::sqrt(squared)};
}

double gap(const Sphere& first, const Sphere& second) {
  return (first.center - second.center).norm() - first.radius - second.radius;
}

Sphere moved(const Sphere& sphere, const Pose& pose) {
  return {pose.R * sphere.center + pose.p, sphere.radius};
}

// Number of postures that tell: one if nothing moves.
std::size_t telling(const std::vector<Pose>& poses) {
  for (const Pose& pose : poses) {
    const double turned = (pose.R - poses.front().R).cwiseAbs().maxCoeff();
    if (std::max(turned, (pose.p - poses.front().p).cwiseAbs().maxCoeff()) >= kRigid) {
      return poses.size();
    }
  }
  return std::min<std::size_t>(1, poses.size());
}

struct Candidate {
  double bound = 0.0;
  std::size_t first = 0, second = 0, posture = 0;

  auto place() const { return std::tie(first, second, posture); }
};

// Order of a heap with the lowest bound on top.
bool later(const Candidate& a, const Candidate& b) {
  return a.bound != b.bound ? a.bound > b.bound : a.place() > b.place();
}

// Pairs of pieces that may come nearer than the limit.
std::vector<Candidate> candidates(const PiecewiseConvex& first, const PiecewiseConvex& second,
                                  const std::vector<Pose>& first_T_second, double limit) {
  std::vector<Candidate> found;
  for (std::size_t posture = 0; posture < telling(first_T_second); ++posture) {
    const Pose& pose = first_T_second[posture];
    if (gap(first.sphere(), moved(second.sphere(), pose)) >= limit) continue;
    for (std::size_t j = 0; j < second.pieces().size(); ++j) {
      const Sphere other = moved(second.spheres()[j], pose);
      if (gap(first.sphere(), other) >= limit) continue;
      for (std::size_t i = 0; i < first.pieces().size(); ++i) {
        const double bound = gap(first.spheres()[i], other);
        if (bound < limit) found.push_back({bound, i, j, posture});
      }
    }
  }
  return found;
}

}  // namespace

PiecewiseConvex::PiecewiseConvex(std::vector<Points> pieces)
    : pieces_(std::move(pieces)), sphere_(sphere_around(pieces_.data(), pieces_.size())) {
  for (const Points& piece : pieces_) spheres_.push_back(sphere_around(&piece, 1));
}

Approach nearest_approach(const PiecewiseConvex& first, const PiecewiseConvex& second,
                          const std::vector<Pose>& first_T_second, double limit) {
  std::vector<Candidate> open = candidates(first, second, first_T_second, limit);
  std::make_heap(open.begin(), open.end(), later);
  Approach nearest{limit, 0};
  Candidate place;
  while (!open.empty() && open.front().bound <= nearest.distance) {
    const Candidate next = open.front();
    std::pop_heap(open.begin(), open.end(), later);
    open.pop_back();
    const double distance =
        signed_distance(first.pieces()[next.first], second.pieces()[next.second],
                        first_T_second[next.posture], nearest.distance);
    const bool earlier = nearest.distance < limit && next.place() < place.place();
    if (distance < nearest.distance || (distance == nearest.distance && earlier)) {
      nearest = {distance, next.posture};
      place = next;
    }
  }
  return nearest;
}

}  // namespace codesign::dynamics
