#include "fem/mesh/solid_euler.hpp"

#include <cstddef>

#include "fem/mesh/tet_corners.hpp"

namespace codesign::fem {

int solid_euler(const Eigen::Ref<const Tets4, 0, Eigen::OuterStride<>>& tets) {
  const TetNeighbors neighbors = tet_neighbors(tets);
  const CornerGroups groups = group_corners(tets, neighbors);
  std::size_t boundary = 0;
  for (const std::array<int, 4>& sides : neighbors)
    for (const int next : sides) boundary += next < 0;
  const std::size_t count = neighbors.size(), sides = (4 * count + boundary) / 2;
  return static_cast<int>(groups.points.count() + sides) -
         static_cast<int>(groups.edges.count() + count);
}

}  // namespace codesign::fem
