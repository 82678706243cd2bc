#pragma once

#include <Eigen/Core>

namespace codesign::dynamics {

// The matrix S(v) with S(v) x = v × x.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

}  // namespace codesign::dynamics
