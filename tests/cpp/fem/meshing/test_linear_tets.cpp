#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "fem/mesh/mesh_quality.hpp"
#include "fem/mesh/tet_neighbors.hpp"
#include "fem/meshing/linear_tets.hpp"

namespace codesign::fem {
namespace {

constexpr double kDegree = M_PI / 180.0;

// Labels every side without neighbor with `label`.
void label_boundary(LinearTets& mesh, int label) {
  const TetNeighbors neighbors =
      tet_neighbors(Eigen::Map<const Tets4>(mesh.tets.data()->data(), std::ssize(mesh.tets), 4));
  mesh.side_label.assign(mesh.tets.size(), {-1, -1, -1, -1});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t k = 0; k < 4; ++k)
      if (neighbors[t][k] < 0) mesh.side_label[t][k] = label;
}

// A pyramid of two tetrahedra over a square whose diagonal 1-3 is lower by h than 0-2, and the
// tetrahedron between the two diagonals.
LinearTets pyramid_with_flat_base(double h) {
  LinearTets mesh;
  mesh.points = {{0, 0, 0}, {1, 0, -h}, {1, 1, 0}, {0, 1, -h}, {0.5, 0.5, -1}};
  mesh.tets = {{0, 1, 3, 4}, {1, 2, 3, 4}, {0, 2, 1, 3}};
  for (auto& tet : mesh.tets) {
    const Eigen::Vector3d a = mesh.points[static_cast<std::size_t>(tet[0])];
    const Eigen::Vector3d b = mesh.points[static_cast<std::size_t>(tet[1])] - a;
    const Eigen::Vector3d c = mesh.points[static_cast<std::size_t>(tet[2])] - a;
    const Eigen::Vector3d d = mesh.points[static_cast<std::size_t>(tet[3])] - a;
    if (b.dot(c.cross(d)) < 0.0) std::swap(tet[0], tet[1]);
  }
  label_boundary(mesh, 0);
  return mesh;
}

TEST(LinearTets, PeelsAFlatElementOfOneFace) {
  LinearTets mesh = pyramid_with_flat_base(1e-4);
  EXPECT_EQ(peel_flat_tets(mesh, 6 * kDegree, 168 * kDegree), 1);
  ASSERT_EQ(mesh.tets.size(), 2u);
  const TetMesh quadratic = to_quadratic(mesh, {"all"});
  EXPECT_EQ(quadratic.boundary.rows(), 6);  // closed again
  EXPECT_GT(measure_quality(quadratic).min_dihedral, 10 * kDegree);
}

TEST(LinearTets, KeepsWhatIsNotFlatOrNotOneFace) {
  LinearTets thick = pyramid_with_flat_base(0.3);
  EXPECT_EQ(peel_flat_tets(thick, 6 * kDegree, 168 * kDegree), 0);
  LinearTets two_faces = pyramid_with_flat_base(1e-4);
  for (std::size_t k = 0; k < 4; ++k)
    if (two_faces.side_label[2][k] >= 0) {
      two_faces.side_label[2][k] = 1;  // one of the two outer sides belongs to another face
      break;
    }
  EXPECT_EQ(peel_flat_tets(two_faces, 6 * kDegree, 168 * kDegree), 0);
}

TEST(LinearTets, DropsCrumbsButNotPieces) {
  LinearTets mesh;
  mesh.points = {{0, 0, 0},     {1, 0, 0},     {0, 1, 0},    {0, 0, 1},
                 {-1e-3, 0, 0}, {0, -1e-3, 0}, {0, 0, -1e-3}};
  mesh.tets = {{0, 1, 2, 3}, {0, 5, 4, 6}};  // they share one point
  label_boundary(mesh, 0);
  LinearTets copy = mesh;
  EXPECT_EQ(remove_crumbs(mesh, 1e-4), 1);
  EXPECT_EQ(mesh.tets.size(), 1u);
  EXPECT_EQ(remove_crumbs(copy, 1e-12), 0);
  EXPECT_EQ(count_pieces(to_quadratic(copy, {""})), 2);
}

TEST(MeshQuality, KnowsTheRegularTetrahedron) {
  LinearTets mesh;
  mesh.points = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  label_boundary(mesh, 0);
  const MeshQuality quality = measure_quality(to_quadratic(mesh, {""}));
  EXPECT_NEAR(quality.min_dihedral, std::acos(1.0 / 3.0), 1e-14);
  EXPECT_NEAR(quality.max_dihedral, std::acos(1.0 / 3.0), 1e-14);
  EXPECT_NEAR(quality.min_radius_ratio, 1.0, 1e-14);
  EXPECT_NEAR(quality.volume, 8.0 / 3.0, 1e-14);
  EXPECT_NEAR(quality.area, 8.0 * std::sqrt(3.0), 1e-13);
}

}  // namespace
}  // namespace codesign::fem
