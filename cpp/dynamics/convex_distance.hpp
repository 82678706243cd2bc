#pragma once

#include <Eigen/Core>
#include <limits>

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

}  // namespace codesign::dynamics
