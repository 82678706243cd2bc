#include <gtest/gtest.h>

#include <numeric>

#include "box_mesh.hpp"
#include "fem/mesh/solid_euler.hpp"
#include "fem/surface/topology.hpp"

namespace codesign::fem {
namespace {

// The cells of a box of n x n x n for which `solid` holds, six tetrahedra each.
template <class Solid>
TetMesh cells(int n, Solid solid) {
  const TetMesh box = box_mesh(n, n, n);
  std::vector<Eigen::Index> rows;
  for (int cell = 0; cell < n * n * n; ++cell)
    for (int k = 0; k < 6; ++k)
      if (solid(cell % n, cell / n % n, cell / n / n)) rows.push_back(6 * cell + k);
  const Tets10 kept = box.tets(rows, Eigen::all);
  std::vector<int> used(kept.data(), kept.data() + kept.size());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::vector<int> number(static_cast<std::size_t>(box.nodes.rows()), -1);
  for (std::size_t i = 0; i < used.size(); ++i)
    number[static_cast<std::size_t>(used[i])] = static_cast<int>(i);
  const Tets10 tets = kept.unaryExpr([&](int i) { return number[static_cast<std::size_t>(i)]; });
  return make_tet_mesh(Points(box.nodes(used, Eigen::all)), tets);
}

int euler_of(const TetMesh& mesh) { return solid_euler(mesh.tets.leftCols<4>()); }

bool is_manifold(const TetMesh& mesh) {
  return measure_topology(mesh.boundary.leftCols<3>()).is_manifold();
}

TEST(SolidEuler, IsHalfThatOfAManifoldBoundary) {
  const TetMesh block = cells(3, [](int, int, int) { return true; });
  const TetMesh torus = cells(3, [](int i, int j, int k) { return k == 0 && (i != 1 || j != 1); });
  const TetMesh hollow = cells(3, [](int i, int j, int k) { return i != 1 || j != 1 || k != 1; });
  EXPECT_EQ(euler_of(block), 1);
  EXPECT_EQ(euler_of(torus), 0);
  EXPECT_EQ(euler_of(hollow), 2);
  for (const TetMesh& mesh : {block, torus, hollow}) {
    const Topology boundary = measure_topology(mesh.boundary.leftCols<3>());
    EXPECT_TRUE(boundary.is_manifold());
    EXPECT_EQ(2 * euler_of(mesh), std::accumulate(boundary.euler.begin(), boundary.euler.end(), 0));
  }
}

TEST(SolidEuler, MaterialThatTouchesAlongAnEdgeOrAtAPointIsApart) {
  const TetMesh edge = cells(2, [](int i, int j, int k) { return i == j && k == 0; });
  const TetMesh point = cells(2, [](int i, int j, int k) { return i == j && j == k; });
  EXPECT_FALSE(is_manifold(edge));
  EXPECT_FALSE(is_manifold(point));
  EXPECT_EQ(euler_of(edge), 2);
  EXPECT_EQ(euler_of(point), 2);
}

// Two shafts that share an edge: the material between them is torn there.
TEST(SolidEuler, HolesThatTouchAlongAnEdgeAreOne) {
  const TetMesh mesh =
      cells(4, [](int i, int j, int k) { return k == 0 && !(i == j && (i == 1 || i == 2)); });
  EXPECT_FALSE(is_manifold(mesh));
  EXPECT_EQ(euler_of(mesh), 0);
}

// The material goes on around the point.
TEST(SolidEuler, CavitiesThatTouchAtAPointAreTwo) {
  const TetMesh mesh =
      cells(4, [](int i, int j, int k) { return !(i == j && j == k && (i == 1 || i == 2)); });
  EXPECT_FALSE(is_manifold(mesh));
  EXPECT_EQ(euler_of(mesh), 3);
}

}  // namespace
}  // namespace codesign::fem
