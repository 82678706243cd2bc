#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "fem/mesh/mesh_quality.hpp"
#include "fem/meshing/mesh_watch.hpp"
#include "fem/meshing/tet_improve.hpp"

namespace codesign::fem {
namespace {

// A double pyramid over a ring of points, with the tips 0 and 1, and its surface: one triangle a
// patch, two at each edge of the ring.
struct Sample {
  SurfaceMesh surface;
  LinearTets mesh;

  Sample(const std::vector<Eigen::Vector3d>& ring, double tip) {
    const int n = static_cast<int>(ring.size());
    mesh.points = {{0, 0, -tip}, {0, 0, tip}};
    mesh.points.insert(mesh.points.end(), ring.begin(), ring.end());
    mesh.dimension.assign(mesh.points.size(), 0);
    surface.points.resize(n + 2, 3);
    for (int i = 0; i < n + 2; ++i) surface.points.row(i) = point(i).transpose();
    surface.triangles.resize(2 * n, 3);
    for (int i = 0; i < n; ++i) {
      surface.triangles.row(2 * i) << 2 + i, 2 + (i + 1) % n, 1;
      surface.triangles.row(2 * i + 1) << 2 + (i + 1) % n, 2 + i, 0;
    }
    surface.face.assign(static_cast<std::size_t>(2 * n), 0);
    surface.face_names = {""};
  }

  const Eigen::Vector3d& point(int i) const { return mesh.points[static_cast<std::size_t>(i)]; }
  std::vector<int> patches() const {
    std::vector<int> patch(surface.face.size());
    std::iota(patch.begin(), patch.end(), 0);
    return patch;
  }
  TetMesh quadratic() const {
    return to_quadratic(mesh, std::vector<std::string>(surface.face.size(), ""));
  }
};

std::vector<Eigen::Vector3d> circle(int n) {
  std::vector<Eigen::Vector3d> ring;
  for (int i = 0; i < n; ++i)
    ring.emplace_back(std::cos(2 * M_PI * i / n), std::sin(2 * M_PI * i / n), 0.0);
  return ring;
}

// An octahedron filled from a point inside it, off the center by `shift` in x and y: the elements
// on that side become flat.
Sample octahedron(double shift) {
  Sample sample(circle(4), 1.0);
  sample.mesh.points.emplace_back(shift, shift, 0.02);
  sample.mesh.dimension.push_back(3);
  for (int t = 0; t < 8; ++t) {
    const Eigen::RowVector3i s = sample.surface.triangles.row(t);
    sample.mesh.tets.push_back({6, s[0], s[1], s[2]});
    sample.mesh.side_label.push_back({t, -1, -1, -1});
  }
  return sample;
}

int improve(Sample& sample, double angle) {
  const SolidOracle oracle(sample.surface, sample.patches());
  MeshWatch watch{MeshOptions{}};
  return improve_tets(sample.mesh, angle, oracle, watch);
}

TEST(TetImprove, MovesAPointOutOfAFlatPlace) {
  Sample sample = octahedron(0.47);
  ASSERT_LT(measure_quality(sample.quadratic()).min_dihedral, 10 * kDegree);
  EXPECT_EQ(improve(sample, 15 * kDegree), 0);
  const TetMesh mesh = sample.quadratic();
  EXPECT_GE(measure_quality(mesh).min_dihedral, 15 * kDegree);
  EXPECT_NEAR(measure_quality(mesh).volume, 4.0 / 3.0, 1e-14);
  EXPECT_EQ(count_pieces(mesh), 1);
  std::vector<int> sides(8, 0);
  for (const int face : mesh.boundary_face) ++sides[static_cast<std::size_t>(face)];
  EXPECT_EQ(sides, std::vector<int>(8, 1));  // every side kept its label
}

TEST(TetImprove, LeavesGoodElementsAlone) {
  Sample sample = octahedron(0.0);
  const std::vector<Eigen::Vector3d> before = sample.mesh.points;
  EXPECT_EQ(improve(sample, 10 * kDegree), 0);
  EXPECT_EQ(sample.mesh.points, before);
  EXPECT_EQ(sample.mesh.tets.size(), 8u);
}

// Three tetrahedra around an axis close to one edge of the ring: two better ones without the axis.
TEST(TetImprove, RemovesAnEdge) {
  Sample sample(circle(3), 0.8);
  for (int tip = 0; tip < 2; ++tip) {
    sample.mesh.points[static_cast<std::size_t>(tip)].x() = -0.45;
    sample.surface.points(tip, 0) = -0.45;
  }
  for (int i = 0; i < 3; ++i) {
    sample.mesh.tets.push_back({0, 2 + i, 2 + (i + 1) % 3, 1});
    sample.mesh.side_label.push_back({2 * i, -1, -1, 2 * i + 1});
  }
  const MeshQuality before = measure_quality(sample.quadratic());
  ASSERT_GT(before.max_dihedral, 160 * kDegree);
  EXPECT_EQ(improve(sample, 20 * kDegree), 0);
  EXPECT_EQ(sample.mesh.tets.size(), 2u);
  const MeshQuality after = measure_quality(sample.quadratic());
  EXPECT_LT(after.max_dihedral, 120 * kDegree);
  EXPECT_NEAR(after.volume, before.volume, 1e-13 * before.volume);
  EXPECT_EQ(sample.quadratic().boundary.rows(), 6);
}

}  // namespace
}  // namespace codesign::fem
