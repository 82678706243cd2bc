#include <gtest/gtest.h>

#include "fem/surface/topology.hpp"

namespace codesign::fem {
namespace {

Triangles tetrahedron(int first) {
  Triangles triangles(4, 3);
  triangles << 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3;
  return triangles.array() + first;
}

Triangles both(const Triangles& a, const Triangles& b) {
  Triangles all(a.rows() + b.rows(), 3);
  all << a, b;
  return all;
}

// A torus of n by n quadrangles.
Triangles torus(int n) {
  Triangles triangles(2 * n * n, 3);
  const auto at = [&](int i, int j) { return (i % n) * n + j % n; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      triangles.row(2 * (i * n + j)) << at(i, j), at(i + 1, j), at(i + 1, j + 1);
      triangles.row(2 * (i * n + j) + 1) << at(i, j), at(i + 1, j + 1), at(i, j + 1);
    }
  return triangles;
}

TEST(Topology, EulerCharacteristicOfEachPiece) {
  EXPECT_EQ(measure_topology(tetrahedron(0)).euler, std::vector<int>{2});
  EXPECT_EQ(measure_topology(torus(4)).euler, std::vector<int>{0});
  const Topology two = measure_topology(both(tetrahedron(100), torus(4)));
  EXPECT_EQ(two.euler, (std::vector<int>{0, 2}));
  EXPECT_TRUE(two.is_manifold());
  EXPECT_EQ(genus_of(0), 1);
}

TEST(Topology, PiecesThatMeetInAPoint) {
  Triangles other = tetrahedron(10);
  other = (other.array() == 10).select(3, other);
  const Topology topology = measure_topology(both(tetrahedron(0), other));
  EXPECT_EQ(topology.euler, (std::vector<int>{2, 2}));
  EXPECT_EQ(topology.pinched_points, 1);
  EXPECT_EQ(topology.open_edges, 0);
  EXPECT_EQ(non_manifold_points(both(tetrahedron(0), other)), std::vector<int>{3});
}

TEST(Topology, EdgesThatDoNotHaveTwoTriangles) {
  const Triangles open = tetrahedron(0).topRows<3>();
  EXPECT_EQ(measure_topology(open).open_edges, 3);
  Triangles other = tetrahedron(10);  // shares the edge 2 3 with the first one
  other = (other.array() == 10).select(2, other);
  other = (other.array() == 11).select(3, other);
  const Topology shared = measure_topology(both(tetrahedron(0), other));
  EXPECT_EQ(shared.open_edges, 4);
  EXPECT_FALSE(shared.is_manifold());
  EXPECT_EQ(non_manifold_points(both(tetrahedron(0), other)), (std::vector<int>{2, 3}));
}

}  // namespace
}  // namespace codesign::fem
