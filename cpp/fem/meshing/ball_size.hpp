#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/meshing/prepared_surface.hpp"

namespace codesign::fem {

// How large protecting balls on feature lines may be so that they stay clear of patches that the
// line does not border: near a corner where a third patch leaves the line at an acute angle, a ball
// as large as its neighbor reaches through that patch, and the boundary cannot become manifold
// there at any edge length.
class BallSize {
 public:
  // `prepared` must outlive this.
  explicit BallSize(const PreparedSurface& prepared) : prepared_(prepared) {}

  // The smaller of `size` and a part of the distance from `p` on line `line` to the nearest patch
  // that is not beside it; where that is on a line, `size`, as balls of lines keep apart from each
  // other. [m]
  double at(const Eigen::Vector3d& p, int line, double size) const;

 private:
  const PreparedSurface& prepared_;
};

}  // namespace codesign::fem
