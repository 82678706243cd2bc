#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace codesign::fem {

// Constrained Delaunay triangles of a flat piece of surface, counter-clockwise seen against
// `normal`: between directed outline edges (pairs of `points`), through the inner points
// `inside`. Nothing if outlines cross or touch.
std::optional<std::vector<std::array<int, 3>>> triangulate_flat(
    const std::vector<Eigen::Vector3d>& points, const std::vector<std::pair<int, int>>& outline,
    const std::vector<int>& inside, const Eigen::Vector3d& normal);

}  // namespace codesign::fem
