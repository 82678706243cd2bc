#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "box_mesh.hpp"
#include "errors.hpp"
#include "fem/elasticity/static_solver.hpp"
#include "fem/mesh/tet10.hpp"
#include "model_error.hpp"

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

namespace {

// A cubic displacement field, its gradient, and the body force that it needs for equilibrium.
Vector3d cubic(const Vector3d& p) {
  const double x = p[0], y = p[1], z = p[2];
  return {x * x * y + z * z * z, y * y * z - x * x * x, z * z * x + 2 * x * y * z};
}

Eigen::Matrix3d cubic_gradient(const Vector3d& p) {
  const double x = p[0], y = p[1], z = p[2];
  Eigen::Matrix3d h;
  h << 2 * x * y, x * x, 3 * z * z, -3 * x * x, 2 * y * z, y * y, z * z + 2 * y * z, 2 * x * z,
      2 * z * x + 2 * x * y;
  return h;
}

// -(lambda + mu) grad div u - mu laplace u
Vector3d cubic_body_force(const Vector3d& p, double lambda, double mu) {
  const double x = p[0], y = p[1], z = p[2];
  // div u = 2 x y + 2 y z + 2 z x + 2 x y
  const Vector3d grad_div(4 * y + 2 * z, 4 * x + 2 * z, 2 * y + 2 * x);
  const Vector3d laplace(2 * y + 6 * z, 2 * z - 6 * x, 2 * x);
  return -(lambda + mu) * grad_div - mu * laplace;
}

struct FieldError {
  double l2, h1;
};

FieldError cubic_error(int n) {
  const Material soft{"unit", 1.0, 0.3, 0.0, 1.0};
  const TetMesh mesh = box_mesh(n, n, n);
  BodyForce body{Points(mesh.nodes.rows(), 3)};
  for (Eigen::Index i = 0; i < mesh.nodes.rows(); ++i) {
    body.force.row(i) =
        cubic_body_force(mesh.nodes.row(i).transpose(), lame_lambda(soft), shear_modulus(soft))
            .transpose();
  }
  const StaticResult r =
      solve_static({mesh, soft, {prescribe(mesh, cubic)}, {body}, no_exclusion()});
  FieldError error{0.0, 0.0};
  TetPoints points;
  TetNodes u;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    const TetNodes x = tet_nodes(mesh, e);
    evaluate_tet(x, tet_rule_14(), points);
    for (int i = 0; i < kTetNodes; ++i) {
      u.col(i) = r.displacement.row(mesh.tets(e, i)).transpose();
    }
    for (std::size_t q = 0; q < 14; ++q) {
      const TetValues values = tet10_values(tet_rule_14().points[q]);
      const Vector3d p = x * values;
      error.l2 += points.weights[q] * (u * values - cubic(p)).squaredNorm();
      error.h1 += points.weights[q] *
                  (u * points.gradients[q].transpose() - cubic_gradient(p)).squaredNorm();
    }
  }
  return {std::sqrt(error.l2), std::sqrt(error.h1)};
}

const auto kRoot = [](const TetMesh& mesh) {
  return Selection{{}, triangles_with_normal(mesh, {-1, 0, 0}, 1e-3), {}};
};
const auto kTip = [](const TetMesh& mesh) {
  return Selection{{}, triangles_with_normal(mesh, {1, 0, 0}, 1e-3), {}};
};

TetMesh beam(int n) {
  return box_mesh(4 * n, n, n, [](const Vector3d& x) -> Vector3d {
    return {0.4 * x[0], 0.1 * x[1], 0.1 * x[2]};
  });
}

std::string message_of(const StaticModel& model) {
  try {
    solve_static(model);
  } catch (const codesign::SolverError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST(StaticSolver, ConvergesWithTheOrdersOfQuadraticElements) {
  const FieldError coarse = cubic_error(4), fine = cubic_error(8);
  EXPECT_GE(std::log2(coarse.l2 / fine.l2), 2.9);
  EXPECT_GE(std::log2(coarse.h1 / fine.h1), 1.9);
  EXPECT_LE(std::log2(coarse.l2 / fine.l2), 3.2);
}

TEST(StaticSolver, ReactionsBalanceTheLoadsAndEnergyIsHalfTheWork) {
  const TetMesh mesh = beam(2);
  const std::vector<Load> loads{Force{kTip(mesh), {10, -20, 30}}, Pressure{kTip(mesh), 1e4},
                                Acceleration{{0, 0, -9.81}}};
  const StaticResult r = solve_static({mesh, kSteel, {{kRoot(mesh)}}, loads, {}});
  const Eigen::VectorXd f = load_vector(mesh, kSteel, loads);
  Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
  double scale = 0.0;
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) {
    const Vector3d total = f.segment<3>(3 * n) + r.reactions.row(n).transpose();
    force += total;
    moment += mesh.nodes.row(n).transpose().cross(total);
    scale += f.segment<3>(3 * n).norm();
  }
  EXPECT_LT(force.norm(), 1e-9 * scale);
  EXPECT_LT(moment.norm(), 1e-9 * scale);
  EXPECT_NEAR(r.work, 2.0 * r.strain_energy, 1e-9 * r.work);
  EXPECT_LT((r.support_forces.row(0).transpose() - r.reactions.colwise().sum().transpose()).norm(),
            1e-12 * scale);
}

// The clamped ends are singular: the limit follows from the last three by Richardson's rule.
TEST(StaticSolver, DisplacementsApproachTheLimitFromBelow) {
  std::vector<double> work;
  for (const int n : {1, 2, 4}) {
    const TetMesh mesh = beam(n);
    work.push_back(
        solve_static({mesh, kSteel, {{kRoot(mesh)}}, {Force{kTip(mesh), {0, 0, 100}}}, {}}).work);
  }
  const double first = work[1] - work[0], second = work[2] - work[1];
  EXPECT_GT(first, 0.0);
  EXPECT_GT(second, 0.0);
  EXPECT_LT(second, 0.5 * first);
  const double limit = work[2] + second * second / (first - second);
  EXPECT_LT(work[2], limit);
  EXPECT_GT(work[2], 0.99 * limit);
}

TEST(StaticSolver, ATurnedPartGivesTheTurnedResult) {
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized())).toRotationMatrix();
  const TetMesh mesh = beam(2);
  TetMesh turned = mesh;
  turned.nodes = mesh.nodes * turn.transpose();
  const Selection root = kRoot(mesh), tip = kTip(mesh);
  const Vector3d force(10, 20, 100);
  const StaticResult a = solve_static({mesh, kSteel, {{root}}, {Force{tip, force}}, {}});
  const StaticResult b = solve_static({turned, kSteel, {{root}}, {Force{tip, turn * force}}, {}});
  EXPECT_LT((b.displacement - a.displacement * turn.transpose()).norm(),
            1e-8 * a.displacement.norm());
  EXPECT_LT((b.von_mises - a.von_mises).norm(), 1e-7 * a.von_mises.norm());
  EXPECT_NEAR(b.peak_stress, a.peak_stress, 1e-6 * a.peak_stress);
  EXPECT_LT((b.peak_position - turn * a.peak_position).norm(), 1e-6);
}

TEST(StaticSolver, OneFactorizationServesManyLoadCases) {
  const TetMesh mesh = beam(2);
  const StaticSystem system(mesh, kSteel, {{kRoot(mesh)}});
  const Force down{kTip(mesh), {0, 0, -100}}, side{kTip(mesh), {0, 50, 0}};
  const StaticResult a = system.solve({down}), b = system.solve({side});
  const StaticResult both = system.solve({down, side});
  EXPECT_LT((both.displacement - a.displacement - b.displacement).norm(),
            1e-10 * both.displacement.norm());
}

TEST(StaticSolver, AMultipleOfALoadCaseHasItsMultipleAnswer) {
  const TetMesh mesh = beam(1);
  const StaticSystem system(mesh, kSteel, {Support{kRoot(mesh)}});
  const std::vector<Load> once{Force{kTip(mesh), {0, 1, 2}}}, thrice{Force{kTip(mesh), {0, 3, 6}}};
  const std::vector<Load> back{Force{kTip(mesh), {0, -1, -2}}};
  const std::vector<StaticResult> results =
      system.solve_all({once, thrice, back}, {"once", "thrice", "back"});
  for (std::size_t i = 0; i < 3; ++i) {
    const StaticResult alone = system.solve(std::vector{once, thrice, back}[i]);
    EXPECT_LT((results[i].displacement - alone.displacement).norm(),
              1e-12 * alone.displacement.norm());
    EXPECT_LT((results[i].stress - alone.stress).norm(), 1e-12 * alone.stress.norm());
    EXPECT_LT((results[i].reactions - alone.reactions).norm(), 1e-12 * alone.reactions.norm());
    EXPECT_NEAR(results[i].safety_factor, alone.safety_factor, 1e-12 * alone.safety_factor);
    EXPECT_NEAR(results[i].stress_error, alone.stress_error, 1e-10 * alone.stress_error);
    EXPECT_NEAR(results[i].stress_50, alone.stress_50, 1e-12 * alone.stress_50);
    EXPECT_NEAR(results[i].left_out.stress, alone.left_out.stress, 1e-12 * alone.peak_stress);
    EXPECT_NEAR(results[i].work, alone.work, 1e-12 * alone.work);
    EXPECT_NEAR(results[i].strain_energy, alone.strain_energy, 1e-12 * alone.work);
    EXPECT_NEAR(results[i].max_displacement, alone.max_displacement, 1e-12);
    EXPECT_EQ(results[i].peak_position, alone.peak_position);
  }
}

TEST(StaticSolver, HalfModelsReportTheWorkOfTheWholePart) {
  const TetMesh whole = box_mesh(4, 4, 2),
                half = box_mesh(4, 2, 2, [](const Vector3d&x) -> Vector3d {
                  return {x[0], 0.5 * x[1], x[2]};
                });
  const Support cut{
      {{}, triangles_with_normal(half, {0, 1, 0}, 1e-3), {}}, {false, true, false}, {}, true};
  StaticSettings settings = no_exclusion();
  const StaticResult a =
      solve_static({whole, kSteel, {{kRoot(whole)}}, {Force{kTip(whole), {0, 0, 100}}}, settings});
  settings.copies = 2;
  const StaticResult b =
      solve_static({half, kSteel, {{kRoot(half)}, cut}, {Force{kTip(half), {0, 0, 50}}}, settings});
  EXPECT_NEAR(b.work, a.work, 0.02 * a.work);  // the halves are split into different tetrahedra
  EXPECT_NEAR(b.stress_50, a.stress_50, 0.1 * a.stress_50);
}

TEST(StaticSolver, NamesTheRigidMotionsThatTheSupportsLeaveFree) {
  const TetMesh mesh = beam(1);
  const std::vector<Load> load{Force{kTip(mesh), {0, 0, 1}}};
  const std::string none = message_of({mesh, kSteel, {}, load, {}});
  for (const char* word : {"translation along x", "translation along y", "translation along z",
                           "rotation about x", "rotation about y", "rotation about z"}) {
    EXPECT_NE(none.find(word), std::string::npos) << none;
  }
  // Held along the edge x = 0, z = 0 only.
  Selection edge;
  for (int n = 0; n < mesh.nodes.rows(); ++n) {
    if (mesh.nodes(n, 0) < 1e-9 && mesh.nodes(n, 2) < 1e-9) edge.nodes.push_back(n);
  }
  const std::string hinge = message_of({mesh, kSteel, {{edge}}, load, {}});
  EXPECT_NE(hinge.find("free to move: rotation about y through (0, 0.05, 0)"), std::string::npos)
      << hinge;
}

TEST(StaticSolver, FindsALoosePieceAndAHinge) {
  // Two boxes side by side, apart or joined along one edge only.
  const TetMesh box = box_mesh(1, 1, 1);
  const int n = static_cast<int>(box.nodes.rows());
  const auto pair = [&](bool joined) {
    Points nodes(2 * n, 3);
    nodes.topRows(n) = box.nodes;
    nodes.bottomRows(n) =
        box.nodes.rowwise() + Eigen::RowVector3d(joined ? 1.0 : 3.0, 0, joined ? 1.0 : 0.0);
    Tets10 tets(2 * box.tets.rows(), 10);
    tets.topRows(box.tets.rows()) = box.tets;
    tets.bottomRows(box.tets.rows()) = box.tets.array() + n;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        if ((nodes.row(n + i) - nodes.row(j)).norm() > 1e-9) continue;
        for (Eigen::Index t = 0; t < tets.size(); ++t) {
          if (tets.data()[t] == n + i) tets.data()[t] = j;
        }
      }
    }
    TetMesh mesh;
    mesh.nodes = nodes;
    mesh.tets = tets;
    return mesh;
  };
  Selection root;
  for (int i = 0; i < n; ++i) {
    if (box.nodes(i, 0) < 1e-9) root.nodes.push_back(i);
  }
  const std::string apart = message_of({pair(false), kSteel, {{root}}, {}, {}});
  EXPECT_NE(apart.find("piece 2 of 2 near (3.5, 0.5, 0.5): translation along x"), std::string::npos)
      << apart;
  EXPECT_EQ(apart.find("piece 1"), std::string::npos) << apart;
  const std::string hinge = message_of({pair(true), kSteel, {{root}}, {}, {}});
  EXPECT_NE(hinge.find("piece 2 of 2 near (1.5, 0.5, 1.5): rotation about y"), std::string::npos)
      << hinge;
}

TEST(StaticSolver, RefusesWhatCannotBeSolved) {
  const TetMesh mesh = beam(1);
  const Support root{kRoot(mesh)};
  TetMesh broken = mesh;
  broken.nodes(0, 0) = std::nan("");
  EXPECT_THROW(solve_static({broken, kSteel, {root}, {}, {}}), codesign::MeshError);
  broken = mesh;
  std::swap(broken.tets(0, 0), broken.tets(0, 1));
  EXPECT_THROW(solve_static({broken, kSteel, {root}, {}, {}}), codesign::MeshError);
  EXPECT_THROW(solve_static({TetMesh{}, kSteel, {root}, {}, {}}), codesign::MeshError);
  Material rubber = kSteel;
  rubber.poisson_ratio = 0.5;
  EXPECT_THROW(solve_static({mesh, rubber, {root}, {}, {}}), std::invalid_argument);
  StaticSettings everywhere;
  everywhere.exclusion_distance = 10.0;
  EXPECT_THROW(solve_static({mesh, kSteel, {root}, {Force{kTip(mesh), {1, 0, 0}}}, everywhere}),
               codesign::ModelError);
  Support moved = root;
  moved.displacement = Points::Ones(1, 3);
  EXPECT_THROW(solve_static({mesh, kSteel, {root, moved}, {}, {}}), codesign::ModelError);
}

TEST(StaticSolver, RefusesLoadsWithoutEffect) {
  const TetMesh mesh = beam(1);
  const Support root{kRoot(mesh)};
  const Force held{kRoot(mesh), {0, 0, 1}}, tip{kTip(mesh), {0, 0, 1}};
  const Force back{kTip(mesh), {0, 0, -1}};
  const StaticSystem system(mesh, kSteel, {root});
  EXPECT_THROW(system.solve({held}), codesign::ModelError);
  EXPECT_THROW(system.displacement({held}), codesign::ModelError);
  EXPECT_THROW(system.solve({tip, held}), codesign::ModelError);
  EXPECT_THROW(system.solve({tip, back}), codesign::ModelError);
  EXPECT_THROW(system.solve({}), codesign::ModelError);
  EXPECT_GT(system.solve({tip}).peak_stress, 0.0);
}

// Elements so flat that conjugate gradients do not converge are factorized, at the cost that was to
// be saved; asked for iteration alone, the same part is refused.
TEST(StaticSolver, FactorizesWhatIterationDoesNotSolve) {
  const TetMesh mesh = box_mesh(24, 6, 1, [](const Vector3d& x) -> Vector3d {
    return {x[0], 0.25 * x[1], 1e-3 * (1.0 + x[0]) * x[2]};
  });
  const Support root{Selection{{}, triangles_in_box(mesh, {-1, -1, -1}, {1e-9, 1, 1}), {}}};
  const Selection tip{{}, triangles_in_box(mesh, {1 - 1e-9, -1, -1}, {2, 1, 1}), {}};
  const auto bent = [&](LinearSolver solver, int eigenvalues) {
    StaticSettings settings = no_exclusion();
    settings.solver = solver;
    settings.eigenvalues = eigenvalues;  // of which so many take too much memory for a factor
    return solve_static({mesh, kSteel, {root}, {Force{tip, {0, 0, -1e-6}}}, settings});
  };
  const StaticResult direct = bent(LinearSolver::direct, 0);
  const StaticResult rescued = bent(LinearSolver::automatic, 10000000);
  EXPECT_EQ(direct.iterations, 0);
  EXPECT_GE(rescued.iterations, 500);
  EXPECT_NEAR(rescued.max_displacement, direct.max_displacement, 1e-6 * direct.max_displacement);
  EXPECT_THROW(bent(LinearSolver::iterative, 0), codesign::SolverError);
}
