#include <gtest/gtest.h>

#include <cmath>

#include "box_mesh.hpp"
#include "fem/mesh/tet10.hpp"
#include "fem/stress/recovery.hpp"

using namespace codesign::fem;
using Eigen::Vector3d;

namespace {

const Material kMaterial{"steel", 210e9, 0.3, 7850.0, 250e6};

Voigt quadratic_stress(const Vector3d& x) {
  Voigt s;
  s << 1 + x[0] * x[1], x[1] * x[1] - x[2], 2 * x[2] + x[0] * x[0], x[0] * x[2], x[1],
      3 - x[2] * x[2];
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
  const Stresses recovered = recover_stress(mesh, points);
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) {
    const Voigt exact = quadratic_stress(mesh.nodes.row(n).transpose());
    EXPECT_LT((recovered.row(n).transpose() - exact).norm(), 1e-5);
  }
}

TEST(Recovery, GivesTheStressOfASingleElement) {
  Points nodes(4, 3);
  nodes << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  Tets4 tets(1, 4);
  tets << 0, 1, 2, 3;
  const TetMesh mesh = make_tet_mesh(nodes, tets);
  PointStresses points;
  points.stress = Stresses::Constant(4, 6, 7.0);
  const Stresses recovered = recover_stress(mesh, points);
  EXPECT_LT((recovered.array() - 7.0).abs().maxCoeff(), 1e-9);
}

TEST(Recovery, ErrorIsZeroForALinearDisplacement) {
  const TetMesh mesh = box_mesh(2, 2, 2);
  Eigen::VectorXd u(3 * mesh.nodes.rows());
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) {
    u.segment<3>(3 * n) = 1e-3 * Vector3d(mesh.nodes(n, 0), mesh.nodes(n, 2), 0.0);
  }
  const Stresses recovered = recover_stress(mesh, point_stresses(mesh, kMaterial, u));
  EXPECT_LT(recovery_error(mesh, kMaterial, u, recovered).relative_energy, 1e-9);
}
