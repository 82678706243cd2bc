#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "box_mesh.hpp"
#include "fem/mesh/tet10.hpp"
#include "fem/stress/body_edges.hpp"
#include "fem/stress/corner_stress.hpp"
#include "fem/stress/recovery.hpp"

using namespace codesign::fem;
using Eigen::Vector3d;

namespace {

const Material kMaterial{"steel", 210e9, 0.3, 7850.0, 250e6};

// With the same body force everywhere: -div = (0, 0, -5).
Voigt quadratic_stress(const Vector3d& p) {
  const double x = p[0], y = p[1], z = p[2];
  Voigt s;
  s << 1 + x * y, y * y - z, x * x + z * z + 5 * z, x * z, x - 2 * y * z - 0.5 * z * z, 3 - y * z;
  return s;
}

}  // namespace

TEST(Recovery, ReproducesAQuadraticStressFromItsPointValues) {
  const TetMesh mesh = box_mesh(3, 3, 3, [](const Vector3d& x) -> Vector3d {
    return x + 0.05 * Vector3d(std::sin(3 * x[1]), x[0] * x[2], std::sin(2 * x[0]));
  });
  PointStresses points;
  points.stress.resize(4 * mesh.tets.rows(), 6);
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    for (int q = 0; q < 4; ++q) {
      const Vector3d x =
          tet_nodes(mesh, e) * tet10_values(tet_rule_4().points[static_cast<std::size_t>(q)]);
      points.stress.row(4 * e + q) = quadratic_stress(x).transpose();
    }
  }
  const Stresses recovered = recover_stress(mesh, body_places(mesh), points);
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) {
    const Voigt exact = quadratic_stress(mesh.nodes.row(n).transpose());
    EXPECT_LT((recovered.row(n).transpose() - exact).norm(), 1e-5);
  }
}

TEST(CornerStress, IsThatOfTheOnlyElementThere) {
  Points nodes(5, 3);  // two elements with a common side: 0 and 4 belong to one each
  nodes << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1;
  Tets4 tets(2, 4);
  tets << 0, 1, 2, 3, 4, 2, 1, 3;
  const TetMesh mesh = make_tet_mesh(nodes, tets);
  Eigen::VectorXd u(3 * mesh.nodes.rows());
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    u[i] = 1e-3 * std::sin(1.0 + 7.0 * static_cast<double>(i));  // any
  }
  const CornerStress found = corner_stress(mesh, body_places(mesh), kMaterial, u);
  ASSERT_EQ(found.nodes, (std::vector{0, 4}));
  const Stresses points = point_stresses(mesh, kMaterial, u).stress;
  const double others = tet_rule_4().points[0][0], own = 1.0 - 3.0 * others;
  for (int e = 0; e < 2; ++e) {  // at its first corner; linear, known from its four points
    const auto four = points.middleRows<4>(4 * e);
    const Voigt exact = (four.row(0) - others * four.colwise().sum()).transpose() / (own - others);
    EXPECT_LT((found.stress.row(e).transpose() - exact).norm(), 1e-9 * exact.norm());
  }
}

TEST(BodyPlaces, OfABoxAndOfACurvedOne) {
  const auto count = [](const TetMesh& mesh, BodyPlace place) {
    const std::vector<BodyPlace> places = body_places(mesh);
    return std::count(places.begin(), places.end(), place);
  };
  const TetMesh box = box_mesh(3, 3, 3);
  EXPECT_EQ(count(box, BodyPlace::corner), 8);
  EXPECT_EQ(count(box, BodyPlace::edge), 12 * 5);  // two corner nodes and three middles each
  // A quarter of a ring in four elements: 22 degrees each, edges bend by less where they are
  // curved.
  const TetMesh ring = box_mesh(1, 4, 1, [](const Vector3d& x) -> Vector3d {
    const double angle = 1.5707963267948966 * x[1];
    return {(1 + x[0]) * std::cos(angle), (1 + x[0]) * std::sin(angle), x[2]};
  });
  EXPECT_EQ(count(ring, BodyPlace::corner), 8);
  EXPECT_EQ(count(ring, BodyPlace::edge), 4 * 7 + 8 * 1);
}

TEST(Recovery, GivesTheStressOfASingleElement) {
  Points nodes(4, 3);
  nodes << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  Tets4 tets(1, 4);
  tets << 0, 1, 2, 3;
  const TetMesh mesh = make_tet_mesh(nodes, tets);
  PointStresses points;
  points.stress = Stresses::Constant(4, 6, 7.0);
  const Stresses recovered = recover_stress(mesh, body_places(mesh), points);
  EXPECT_LT((recovered.array() - 7.0).abs().maxCoeff(), 1e-9);
}

TEST(Recovery, ErrorIsZeroForALinearDisplacement) {
  const TetMesh mesh = box_mesh(2, 2, 2);
  Eigen::VectorXd u(3 * mesh.nodes.rows());
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) {
    u.segment<3>(3 * n) = 1e-3 * Vector3d(mesh.nodes(n, 0), mesh.nodes(n, 2), 0.0);
  }
  const Stresses recovered =
      recover_stress(mesh, body_places(mesh), point_stresses(mesh, kMaterial, u));
  EXPECT_LT(recovery_error(mesh, kMaterial, u, recovered).relative_energy, 1e-9);
}
