#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "box_mesh.hpp"
#include "errors.hpp"
#include "fem/elasticity/static_solver.hpp"
#include "fem/elasticity/substructure.hpp"
#include "fem/meshing/stretch.hpp"

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

const Material kSteel{"steel", 210e9, 0.3, 7850.0, 250e6};

// A bar held at x = 0 and pulled aside at its end: what lies behind the zone hangs on it alone.
struct Bar {
  TetMesh mesh = box_mesh(8, 2, 2);
  Stretch stretch{Vector3d::Zero(), Vector3d::UnitX(), 0.3, 0.7, 0.0};
  std::vector<Support> supports;
  std::vector<Load> loads;

  Bar() {
    Support clamp;
    clamp.where.nodes = nodes_at(0.0);
    supports.push_back(clamp);
    Support guide;  // one component of some nodes that are shared too
    guide.where.nodes = nodes_at(0.25);
    guide.fixed = {false, false, true};
    supports.push_back(guide);
    loads.push_back(Acceleration{Vector3d(10.0, 1000.0, 30.0)});
  }

  std::vector<int> nodes_at(double x) const {
    std::vector<int> nodes;
    for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n)
      if (std::abs(mesh.nodes(n, 0) - x) < 1e-12) nodes.push_back(static_cast<int>(n));
    return nodes;
  }

  std::shared_ptr<const KeptElements> kept() const {
    return keep_elements(mesh, reshaped_tets(mesh, stretch), kSteel, constrain(mesh, supports),
                         {kMemoryLimit, 1e12});
  }
};

// The displacement of each node is that of one factor of all elements, in double precision.
TEST(Substructure, ChangesNothingInASolution) {
  Bar bar;
  StaticSettings settings;
  settings.residual_tolerance = 1e-12;
  for (const double change : {0.0, 0.2, -0.15}) {
    bar.stretch.change = change;
    const TetMesh mesh = stretched(bar.mesh, bar.stretch);
    const StaticSystem whole(mesh, kSteel, bar.supports, settings);
    const StaticSystem pieces(mesh, kSteel, bar.supports, settings, {}, bar.kept());
    const StaticResult a = whole.solve(bar.loads), b = pieces.solve(bar.loads);
    EXPECT_EQ(a.equations, b.equations);
    EXPECT_LT((a.displacement - b.displacement).norm(), 1e-11 * a.displacement.norm());
    EXPECT_NEAR(a.peak_stress, b.peak_stress, 1e-10 * a.peak_stress);
    EXPECT_LT(b.residual, 1e-11);
  }
}

TEST(Substructure, ServesEigenvaluesToo) {
  Bar bar;
  const StaticSystem whole(bar.mesh, kSteel, bar.supports);
  const StaticSystem pieces(bar.mesh, kSteel, bar.supports, {}, {}, bar.kept());
  EXPECT_TRUE(pieces.natural_modes(3).frequency.isApprox(whole.natural_modes(3).frequency, 1e-9));
}

// The mean of a stiffness over rigid motions is zero where the rest of the part holds nothing.
TEST(Substructure, OfAFreePieceResistsNoRigidMotion) {
  Bar bar;
  std::vector<int> behind;
  for (int e = 0; e < bar.mesh.tets.rows(); ++e) {
    double least = 1.0;
    for (int i = 0; i < 4; ++i) least = std::min(least, bar.mesh.nodes(bar.mesh.tets(e, i), 0));
    if (least >= 0.75 - 1e-12) behind.push_back(e);
  }
  const std::vector<int> shared = bar.nodes_at(0.75);
  TetMesh chosen = bar.mesh;
  chosen.tets = bar.mesh.tets(behind, Eigen::all);
  const Substructure piece(chosen, kSteel, constrain(bar.mesh, {}), shared, {kMemoryLimit, 1e12});
  const Eigen::MatrixXd stiffness =
      piece.stiffness().cast<double>().selfadjointView<Eigen::Lower>();
  Eigen::VectorXd turn(stiffness.rows());
  for (std::size_t k = 0; k < shared.size(); ++k) {
    const Vector3d x = bar.mesh.nodes.row(shared[k]);
    turn.segment<3>(static_cast<Eigen::Index>(3 * k)) =
        Vector3d(1.0, 2.0, 3.0) + Vector3d(0.3, -0.2, 0.5).cross(x);
  }
  EXPECT_LT((stiffness * turn).norm(), 1e-6 * stiffness.norm() * turn.norm());
}

// A fishing rod: its stiffest and softest motions are further apart than single precision reaches.
TEST(Substructure, SaysWhatSinglePrecisionDoesNotResolve) {
  Bar bar;
  bar.mesh = box_mesh(200, 1, 1);
  bar.mesh.nodes.rightCols(2) *= 3e-3;
  bar.supports.front().where.nodes = bar.nodes_at(0.0);
  bar.supports.pop_back();
  const StaticSystem whole(bar.mesh, kSteel, bar.supports);
  EXPECT_LE(whole.solve(bar.loads).residual, 1e-9);
  EXPECT_THROW(StaticSystem(bar.mesh, kSteel, bar.supports, {}, {}, bar.kept()).solve(bar.loads),
               SolverError);
}

TEST(Substructure, KeepsToItsLimits) {
  const Bar bar;
  EXPECT_THROW(keep_elements(bar.mesh, reshaped_tets(bar.mesh, bar.stretch), kSteel,
                             constrain(bar.mesh, bar.supports), {1e3, 1e12}),
               MemoryLimitError);
}

}  // namespace
}  // namespace codesign::fem
