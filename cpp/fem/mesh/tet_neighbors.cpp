#include "fem/mesh/tet_neighbors.hpp"

#include <algorithm>
#include <bit>
#include <string>

#include "errors.hpp"

namespace codesign::fem {
namespace {

// Open-addressed table of the sides met so far; `owner` is 4 · tetrahedron + side, -1 free.
struct SideTable {
  struct Slot {
    std::array<int, 3> corners;
    int owner = -1;
    bool paired = false;
  };
  std::vector<Slot> slots;
  std::size_t mask;

  explicit SideTable(std::size_t sides)
      : slots(std::bit_ceil(2 * sides + 2)), mask(slots.size() - 1) {}

  Slot& find(const std::array<int, 3>& corners) {
    std::uint64_t h = 0;
    for (const int c : corners) h = (h ^ static_cast<std::uint32_t>(c)) * 0x9E3779B97F4A7C15ull;
    std::size_t at = static_cast<std::size_t>(h >> 20) & mask;
    while (slots[at].owner >= 0 && slots[at].corners != corners) at = (at + 1) & mask;
    return slots[at];
  }
};

}  // namespace

TetNeighbors tet_neighbors(const Eigen::Ref<const Tets4, 0, Eigen::OuterStride<>>& tets) {
  TetNeighbors neighbors(static_cast<std::size_t>(tets.rows()), {-1, -1, -1, -1});
  // Every inner side is met twice: 2 m sides and a few more on the boundary.
  SideTable table(static_cast<std::size_t>(4 * tets.rows()));
  for (int t = 0; t < static_cast<int>(tets.rows()); ++t)
    for (int k = 0; k < 4; ++k) {
      std::array<int, 3> corners{tets(t, kTetSides[k][0]), tets(t, kTetSides[k][1]),
                                 tets(t, kTetSides[k][2])};
      std::sort(corners.begin(), corners.end());
      SideTable::Slot& slot = table.find(corners);
      if (slot.owner < 0) {
        slot = {corners, 4 * t + k, false};
        continue;
      }
      if (slot.paired)
        throw MeshError("the side of nodes " + std::to_string(corners[0]) + " " +
                        std::to_string(corners[1]) + " " + std::to_string(corners[2]) +
                        " belongs to more than two tetrahedra");
      slot.paired = true;
      const auto other = static_cast<std::size_t>(slot.owner / 4);
      neighbors[other][static_cast<std::size_t>(slot.owner % 4)] = t;
      neighbors[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)] = slot.owner / 4;
    }
  return neighbors;
}

}  // namespace codesign::fem
