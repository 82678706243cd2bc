#include "fem/mesh/solid_euler.hpp"

#include <array>
#include <cstddef>

#include "fem/mesh/tet10.hpp"
#include "fem/surface/disjoint_sets.hpp"

namespace codesign::fem {
namespace {

// The edge between two corners, in the order of kTetEdges.
constexpr std::array<std::array<std::size_t, 4>, 4> kEdgeOf = [] {
  std::array<std::array<std::size_t, 4>, 4> edge_of{};
  for (std::size_t e = 0; e < 6; ++e) {
    const auto a = static_cast<std::size_t>(kTetEdges[e][0]);
    const auto b = static_cast<std::size_t>(kTetEdges[e][1]);
    edge_of[a][b] = edge_of[b][a] = e;
  }
  return edge_of;
}();

}  // namespace

int solid_euler(const Eigen::Ref<const Tets4, 0, Eigen::OuterStride<>>& tets) {
  const TetNeighbors neighbors = tet_neighbors(tets);
  const std::size_t count = neighbors.size();
  DisjointSets points(4 * count), edges(6 * count);
  std::size_t boundary = 0;
  for (std::size_t t = 0; t < count; ++t)
    for (std::size_t k = 0; k < 4; ++k) {
      const int next = neighbors[t][k];
      boundary += next < 0;
      if (next <= static_cast<int>(t)) continue;
      const auto other = static_cast<std::size_t>(next);
      std::array<std::size_t, 3> here{}, there{};  // corners of the common side
      for (std::size_t i = 0; i < 3; ++i) {
        here[i] = static_cast<std::size_t>(kTetSides[k][i]);
        const int point = tets(static_cast<Eigen::Index>(t), kTetSides[k][i]);
        while (tets(next, static_cast<Eigen::Index>(there[i])) != point) ++there[i];
        points.join(4 * t + here[i], 4 * other + there[i]);
      }
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        edges.join(6 * t + kEdgeOf[here[i]][here[j]], 6 * other + kEdgeOf[there[i]][there[j]]);
      }
    }
  const std::size_t sides = (4 * count + boundary) / 2;
  return static_cast<int>(points.count() + sides) - static_cast<int>(edges.count() + count);
}

}  // namespace codesign::fem
