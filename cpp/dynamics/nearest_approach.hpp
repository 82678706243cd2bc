#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dynamics/spatial.hpp"

// Where two bodies of convex pieces come nearest while they move. Spheres around the pieces bound
// their distances from below, so that those of few pairs are computed (convex_distance.hpp).
namespace codesign::dynamics {

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
