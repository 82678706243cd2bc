#include "fem/mesh/boundary_neighbors.hpp"

#include <array>
#include <cstddef>
#include <vector>

#include "fem/mesh/tet_neighbors.hpp"

namespace codesign::fem {
namespace {

class EdgeWalk {
 public:
  explicit EdgeWalk(const TetMesh& mesh)
      : mesh_(mesh),
        across_(tet_neighbors(mesh.tets.leftCols<4>())),
        row_(across_.size(), {-1, -1, -1, -1}) {
    for (std::size_t t = 0; t < across_.size(); ++t)  // the order of mesh.boundary
      for (std::size_t k = 0; k < 4; ++k) {
        if (across_[t][k] >= 0) continue;
        row_[t][k] = static_cast<int>(side_.size());
        side_.push_back({static_cast<int>(t), static_cast<int>(k)});
      }
  }

  std::size_t sides() const { return side_.size(); }

  // From boundary side `row`, about its edge from corner k to k + 1.
  int turn(std::size_t row, int k) const {
    const auto i = static_cast<Eigen::Index>(row);
    const int a = mesh_.boundary(i, k), b = mesh_.boundary(i, (k + 1) % 3);
    int t = side_[row].tet;
    int ahead = mesh_.boundary(i, (k + 2) % 3);  // the walk leaves through the side opposite to it
    int other = mesh_.tets(t, side_[row].opposite);
    for (;;) {
      const std::size_t exit = corner_of(t, ahead);
      const int next = across_[static_cast<std::size_t>(t)][exit];
      if (next < 0) return row_[static_cast<std::size_t>(t)][exit];
      t = next;
      ahead = other;
      for (int c = 0; c < 4; ++c)
        if (const int node = mesh_.tets(t, c); node != a && node != b && node != ahead)
          other = node;
    }
  }

 private:
  struct Side {
    int tet, opposite;
  };

  std::size_t corner_of(int t, int node) const {
    std::size_t c = 0;
    while (mesh_.tets(t, static_cast<Eigen::Index>(c)) != node) ++c;
    return c;
  }

  const TetMesh& mesh_;
  TetNeighbors across_;
  std::vector<std::array<int, 4>> row_;  // of mesh_.boundary, by tetrahedron and side
  std::vector<Side> side_;               // by row of mesh_.boundary
};

}  // namespace

Neighbors boundary_neighbors(const TetMesh& mesh) {
  const EdgeWalk walk(mesh);
  Neighbors neighbors(walk.sides());
  for (std::size_t row = 0; row < neighbors.size(); ++row)
    for (int k = 0; k < 3; ++k) neighbors[row][static_cast<std::size_t>(k)] = walk.turn(row, k);
  return neighbors;
}

}  // namespace codesign::fem
