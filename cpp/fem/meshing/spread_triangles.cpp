#include "fem/meshing/spread_triangles.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMost = 12;

}  // namespace

std::vector<int> spread_triangles(const SurfaceMesh& surface, const std::vector<int>& shell,
                                  int which) {
  const auto center = [&](int t) -> Vector3d {
    return (corner(surface, t, 0) + corner(surface, t, 1) + corner(surface, t, 2)) / 3.0;
  };
  std::vector<int> members, chosen;
  for (std::size_t t = 0; t < shell.size(); ++t)
    if (shell[t] == which) members.push_back(static_cast<int>(t));
  std::vector<double> distance(members.size(), std::numeric_limits<double>::infinity());
  for (std::size_t next = 0; chosen.size() < kMost && distance[next] > 0.0;) {
    chosen.push_back(members[next]);
    const Vector3d p = center(members[next]);
    for (std::size_t i = 0; i < members.size(); ++i)
      distance[i] = std::min(distance[i], (center(members[i]) - p).squaredNorm());
    next = static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) -
                                    distance.begin());
  }
  return chosen;
}

}  // namespace codesign::fem
