#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/meshing/prepared_surface.hpp"

namespace codesign::fem {

// How thick the solid is at a place of its surface, or how wide the gap outside.
struct WallSample {
  Eigen::Vector3d point;  // m
  double thickness;       // m, at most the limit that was asked for
  double area;            // of the surface that it stands for, m²; 0 for lines and gaps
};

// Samples of the whole surface, at half the wall thickness from each other, and of the
// feature lines where they come near a patch that does not meet them. Faces that meet at an edge
// are no wall however thin they make its surroundings: a wedge needs no small elements.
// limit: thicker walls and wider gaps are of no interest, m.
std::vector<WallSample> find_walls(const PreparedSurface& prepared, double limit);

}  // namespace codesign::fem
