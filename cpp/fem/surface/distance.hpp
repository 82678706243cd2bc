#pragma once

#include <Eigen/Core>

namespace codesign::fem {

// Squared distance of p to the triangle a b c (m²), and to the segment a b.
double squared_distance_to_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                    const Eigen::Vector3d& b, const Eigen::Vector3d& c);
double squared_distance_to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                   const Eigen::Vector3d& b);

}  // namespace codesign::fem
