#include <gtest/gtest.h>

#include <cmath>

#include "box_mesh.hpp"
#include "errors.hpp"
#include "fem/static_solver.hpp"

using namespace codesign::fem;
using Eigen::Vector3d;

namespace {

const Material kSteel{"steel", 210e9, 0.3, 7850.0, 250e6};

// Interior nodes moved at random (straight elements), or all nodes bent (curved elements).
TetMesh distorted(bool curved) {
  TetMesh mesh = box_mesh(3, 3, 3);
  if (curved) {
    return box_mesh(3, 3, 3, [](const Vector3d& x) -> Vector3d {
      return x + 0.08 * Vector3d(std::sin(3 * x[1] * x[2]), std::sin(2 * x[0] + x[2]), x[0] * x[1]);
    });
  }
  std::srand(7);
  Points corners = mesh.nodes;
  for (Eigen::Index n = 0; n < corners.rows(); ++n) {
    const bool inside =
        (corners.row(n).array() > 1e-9).all() && (corners.row(n).array() < 1 - 1e-9).all();
    if (inside) corners.row(n) += 0.08 * Eigen::RowVector3d::Random();
  }
  return make_tet_mesh(corners.topRows(64), Tets4(mesh.tets.leftCols<4>()));
}

Support prescribe(const TetMesh& mesh, const std::function<Vector3d(const Vector3d&)>& field) {
  Support s;
  s.where.nodes = boundary_nodes(mesh);
  s.displacement.resize(static_cast<Eigen::Index>(s.where.nodes.size()), 3);
  for (std::size_t i = 0; i < s.where.nodes.size(); ++i) {
    s.displacement.row(static_cast<Eigen::Index>(i)) =
        field(mesh.nodes.row(s.where.nodes[i]).transpose()).transpose();
  }
  return s;
}

StaticSettings no_exclusion() {
  StaticSettings s;
  s.exclusion_distance = 0.0;
  return s;
}

}  // namespace

// A linear displacement on the boundary gives the same linear displacement and the constant stress
// everywhere, whatever the elements' shape.
TEST(StaticSolver, PassesThePatchTestOnDistortedAndCurvedElements) {
  Eigen::Matrix3d gradient;
  gradient << 1e-3, 2e-4, -3e-4, 5e-4, -4e-4, 1e-4, 2e-4, 6e-4, 7e-4;
  const auto field = [&](const Vector3d& x) -> Vector3d { return gradient * x; };
  Voigt strain;
  strain << gradient(0, 0), gradient(1, 1), gradient(2, 2), gradient(0, 1) + gradient(1, 0),
      gradient(1, 2) + gradient(2, 1), gradient(2, 0) + gradient(0, 2);
  const Voigt stress = stress_of_strain(lame_lambda(kSteel), shear_modulus(kSteel), strain);
  for (const bool curved : {false, true}) {
    const TetMesh mesh = distorted(curved);
    const StaticResult r =
        solve_static({mesh, kSteel, {prescribe(mesh, field)}, {}, no_exclusion()});
    for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) {
      EXPECT_LT((r.displacement.row(n).transpose() - field(mesh.nodes.row(n).transpose())).norm(),
                1e-10 * 1e-3);
      EXPECT_LT((r.stress.row(n).transpose() - stress).norm(), 1e-10 * stress.norm());
    }
    EXPECT_LT(r.residual, 1e-12);
  }
}
