#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

#include "dynamics/spatial.hpp"

// Distance and penetration depth of convex hulls, on their Minkowski difference D = first − second:
// the hulls overlap where D holds the origin.
//
// Distance: Gilbert, Johnson, Keerthi, "A fast procedure for computing the distance between complex
// objects in three-dimensional space" (1988). Depth: expanding polytope, after van den Bergen,
// "Proximity queries and penetration depth computation on 3D game objects" (2001).
namespace codesign::dynamics {

// Columns are points in the hull's own frame [m], at least one; points inside the hull do no harm.
using HullPoints = Eigen::Ref<const Eigen::Matrix3Xd>;

// Distance of two hulls [m]; if they overlap, minus the length of the shortest translation that
// parts them. Flat hulls that intersect give 0. What is above `limit` may come out as any other
// number that is: a search for the smallest needs no more, and most hulls are soon known to be
// apart.
double signed_distance(const HullPoints& first, const HullPoints& second,
                       const Pose& first_T_second,
                       double limit = std::numeric_limits<double>::infinity());

// Where two bodies of convex pieces come nearest while they move. Spheres around the pieces bound
// their distances from below, so that those of few pairs are computed.

// What contains a piece: center and radius [m] in its body's frame.
struct Sphere {
  Eigen::Vector3d center;
  double radius;
};

// A body's pieces, points in its frame [m], with the spheres around them. At least one piece, each
// of at least one point; the points are not copied.
class PiecewiseConvex {
 public:
  using Points = Eigen::Map<const Eigen::Matrix3Xd>;

  explicit PiecewiseConvex(std::vector<Points> pieces);

  const std::vector<Points>& pieces() const { return pieces_; }
  const std::vector<Sphere>& spheres() const { return spheres_; }  // around each piece
  const Sphere& sphere() const { return sphere_; }                 // around all

 private:
  std::vector<Points> pieces_;
  std::vector<Sphere> spheres_;
  Sphere sphere_;
};

// How near two bodies come, and in which posture.
struct Approach {
  double distance;      // signed [m], see signed_distance; the limit if it is nowhere below
  std::size_t posture;  // where that is
};

// The nearest approach of two bodies over postures, if it is below a limit [m]. Of several that are
// equally near the first one by piece of the first body, of the second, and posture.
Approach nearest_approach(const PiecewiseConvex& first, const PiecewiseConvex& second,
                          const std::vector<Pose>& first_T_second, double limit);

}  // namespace codesign::dynamics
