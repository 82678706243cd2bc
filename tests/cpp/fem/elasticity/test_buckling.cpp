#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "box_mesh.hpp"
#include "errors.hpp"
#include "fem/elasticity/static_solver.hpp"
#include "fem/elasticity/stiffness.hpp"
#include "fem/la/block_krylov.hpp"
#include "model_error.hpp"

using namespace codesign::fem;
using Eigen::Vector3d;

namespace {

constexpr double kPi = 3.14159265358979323846;
const Material kUnit{"unit", 1.0, 0.0, 1.0, 1.0};

// A nodal field (3 n) from a function of position.
Eigen::VectorXd nodal(const TetMesh& mesh, const std::function<Vector3d(const Vector3d&)>& field) {
  Eigen::VectorXd values(3 * mesh.nodes.rows());
  for (Eigen::Index i = 0; i < mesh.nodes.rows(); ++i) {
    values.segment<3>(3 * i) = field(mesh.nodes.row(i).transpose());
  }
  return values;
}

// wᵀ K_sigma w of a part without supports.
double stress_work(const TetMesh& mesh, const Material& material, const Eigen::VectorXd& u,
                   const Eigen::VectorXd& w) {
  const NodePattern pattern = order_nodes(mesh, constrain(mesh, {}));
  Eigen::VectorXd free(pattern.equations());
  for (Eigen::Index d = 0; d < w.size(); ++d) {
    free[pattern.equation[static_cast<std::size_t>(d)]] = w[d];
  }
  return free.dot(multiply(assemble_geometric_stiffness(mesh, material, u, pattern), free));
}

// A column of square section 1 along x, clamped at x = 0.
constexpr double kLength = 20.0;
TetMesh column(int cells) {
  return box_mesh(cells, 1, 1, [](const Vector3d& x) -> Vector3d {
    return {kLength * x[0], x[1], x[2]};
  });
}

BucklingModes press(const TetMesh& mesh, double force, int count, StaticSettings settings = {}) {
  const Selection root{{}, triangles_with_normal(mesh, {-1, 0, 0}, 1e-6), {}};
  const Selection tip{{}, triangles_with_normal(mesh, {1, 0, 0}, 1e-6), {}};
  const StaticSystem system(mesh, kUnit, {Support{root}}, settings);
  return system.buckling_modes(system.displacement({Force{tip, {-force, 0, 0}}}), count);
}

}  // namespace

// Uniform stress, linear field: V tr(H sigma Hᵀ), on curved elements too.
TEST(GeometricStiffness, IsExactForUniformStress) {
  const TetMesh mesh = box_mesh(2, 2, 2, [](const Vector3d& x) -> Vector3d {
    return x + 0.08 * Vector3d(std::sin(3 * x[1] * x[2]), std::sin(2 * x[0] + x[2]), x[0] * x[1]);
  });
  const Material steel{"steel", 210e9, 0.3, 7850.0, 250e6};
  Eigen::Matrix3d strained, turned;
  strained << 1e-3, 2e-4, -3e-4, 5e-4, -4e-4, 1e-4, 2e-4, 6e-4, 7e-4;
  turned << 0.1, -0.7, 0.4, 0.8, 0.2, -0.3, -0.5, 0.6, -0.1;
  const Voigt s =
      stress_of_gradient(lame_lambda(steel), shear_modulus(steel), strained);  // xx yy zz xy yz zx
  Eigen::Matrix3d stress;
  stress << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  double volume = 0.0;
  TetPoints points;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    evaluate_tet(tet_nodes(mesh, e), tet_rule_14(), points);
    volume += std::accumulate(points.weights.begin(), points.weights.end(), 0.0);
  }
  const double work =
      stress_work(mesh, steel, nodal(mesh, [&](const Vector3d& x) { return strained * x; }),
                  nodal(mesh, [&](const Vector3d& x) { return turned * x; }));
  const double exact = volume * (turned * stress * turned.transpose()).trace();
  EXPECT_NEAR(work, exact, 1e-12 * std::abs(exact));
}

// Stress -x, field x² across: the integrand has degree 3, which four points do not integrate.
TEST(GeometricStiffness, IsExactForLinearStress) {
  const TetMesh mesh = box_mesh(1, 1, 1);
  const double work =
      stress_work(mesh, kUnit,
                  nodal(mesh, [](const Vector3d& x) { return Vector3d(-0.5 * x[0] * x[0], 0, 0); }),
                  nodal(mesh, [](const Vector3d& x) { return Vector3d(0, x[0] * x[0], 0); }));
  EXPECT_NEAR(work, -1.0, 1e-12);
}

TEST(BlockKrylov, FindsBothEndsOfASpectrumInAnInnerProduct) {
  const Eigen::Index n = 101;
  const Eigen::VectorXd mass = Eigen::VectorXd::LinSpaced(n, 1.0, 3.0);
  const Eigen::VectorXd value = Eigen::VectorXd::LinSpaced(n, -40.0, 60.0);
  const auto apply = [&](const Eigen::MatrixXd& v, const Eigen::MatrixXd&) -> Eigen::MatrixXd {
    return value.asDiagonal() * v;
  };
  const LinearMap inner = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
    return mass.cwiseProduct(v);
  };
  const Eigenpairs found =
      extreme_eigenpairs(inner, apply, random_block(n, 4), {.largest = 3, .smallest = 2});
  EXPECT_LT((found.values.head(3) - Vector3d(60, 59, 58)).norm(), 1e-6);
  EXPECT_LT((found.values.tail(2) - Eigen::Vector2d(-40, -39)).norm(), 1e-6);
  const Eigen::MatrixXd gram = found.vectors.transpose() * mass.asDiagonal() * found.vectors;
  EXPECT_LT((gram - Eigen::MatrixXd::Identity(5, 5)).norm(), 1e-10);
  EXPECT_NEAR(std::abs(found.vectors(n - 2, 1)) * std::sqrt(mass[n - 2]), 1.0, 1e-6);
  EXPECT_NEAR(std::abs(found.vectors(1, 4)) * std::sqrt(mass[1]), 1.0, 1e-6);
}

// Euler: pi² E I / (4 L²), less what shear takes; without lateral contraction the clamp adds
// nothing.
TEST(Buckling, AColumnBucklesAtEulersForceFromAbove) {
  const double inertia = 1.0 / 12.0, area = 1.0;
  const double euler = kPi * kPi * inertia / (4 * kLength * kLength);
  const double exact = euler / (1 + euler / (5.0 / 6.0 * area * shear_modulus(kUnit)));
  double last = std::numeric_limits<double>::infinity();
  for (const int cells : {5, 10, 20}) {
    const BucklingModes modes = press(column(cells), 1e-6, 2);
    ASSERT_EQ(modes.factor.size(), 2);
    const double force = 1e-6 * modes.factor[0];
    EXPECT_GT(force, 0.999 * exact);  // the solid also shortens, by exact / (E area) = 5e-4
    EXPECT_LT(force, last);
    last = force;
  }
  EXPECT_NEAR(last, exact, 1e-3 * exact);
}

TEST(Buckling, FactorsScaleWithTheLoadAndTurnWithItsSign) {
  const TetMesh mesh = column(6);
  const BucklingModes pressed = press(mesh, 1e-6, 2), twice = press(mesh, 2e-6, 2);
  const BucklingModes pulled = press(mesh, -1e-6, 2);
  EXPECT_LT((pressed.factor - 2 * twice.factor).norm(), 1e-8 * pressed.factor.norm());
  EXPECT_EQ(pressed.reversed, std::numeric_limits<double>::infinity());
  EXPECT_EQ(pulled.factor.size(), 0);
  EXPECT_EQ(pulled.shape.cols(), 0);
  EXPECT_NEAR(pulled.reversed, pressed.factor[0], 1e-8 * pressed.factor[0]);
  EXPECT_THROW(press(mesh, 0.0, 2), codesign::ModelError);  // nothing is loaded
}

TEST(Buckling, ShapesAreScaledAndHeldAtTheSupports) {
  const TetMesh mesh = column(6);
  const BucklingModes modes = press(mesh, 1e-6, 1);
  const Eigen::Map<const Points> moved(modes.shape.data(), mesh.nodes.rows(), 3);
  EXPECT_NEAR(moved.rowwise().norm().maxCoeff(), 1.0, 1e-12);
  for (Eigen::Index i = 0; i < mesh.nodes.rows(); ++i) {
    const double side = moved.row(i).tail<2>().norm();
    EXPECT_NEAR(side, 1 - std::cos(0.5 * kPi * mesh.nodes(i, 0) / kLength), 0.01);
  }
}

// Pressed on a small spot, it has eigenvalues below the limit of 1 % of its volume; but they belong
// to waves within the spot, where the stress is of the size of the shear modulus.
TEST(Buckling, ACompactBlockDoesNotBuckle) {
  const TetMesh mesh = box_mesh(8, 8, 8);
  const Selection root{{}, triangles_with_normal(mesh, {0, 0, -1}, 1e-6), {}};
  const Selection spot{{}, triangles_in_box(mesh, {0.37, 0.37, 0.99}, {0.51, 0.51, 1.01}), {}};
  const StaticSystem system(mesh, kUnit, {Support{root}});
  const Points u = system.displacement({Force{spot, {0, 0, -1e-6}}});
  const BucklingModes one = system.buckling_modes(u, 1), four = system.buckling_modes(u, 4);
  EXPECT_EQ(one.factor.size(), 0);
  EXPECT_EQ(four.factor.size(), 0);
  EXPECT_LT(one.limit, four.limit);  // the first of the modes that do not count, and the fourth
  const double spot_stress = 1e-6 * 8 * 8;
  EXPECT_GT(one.limit * spot_stress, shear_modulus(kUnit));
}

TEST(Buckling, NeedsNoFactorOfTheStaticSolution) {
  const TetMesh mesh = column(6);
  StaticSettings iterative;
  iterative.solver = LinearSolver::iterative;
  const double direct = press(mesh, 1e-6, 1).factor[0];
  EXPECT_NEAR(press(mesh, 1e-6, 1, iterative).factor[0], direct, 1e-6 * direct);
}

TEST(Buckling, RefusesWhatMakesNoSense) {
  const TetMesh mesh = column(2);
  EXPECT_THROW(press(mesh, 1e-6, 0), std::invalid_argument);
  EXPECT_THROW(buckling_modes(mesh, kUnit, {}, Points::Zero(mesh.nodes.rows(), 3), 1),
               codesign::SolverError);
  const Support all{Selection{{}, triangles_with_normal(mesh, {-1, 0, 0}, 1e-6), {}}};
  EXPECT_THROW(buckling_modes(mesh, kUnit, {all}, Points::Zero(2, 3), 1), std::invalid_argument);
}
