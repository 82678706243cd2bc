#include <gtest/gtest.h>

#include <Eigen/LU>
#include <vector>

#include "box_mesh.hpp"
#include "errors.hpp"
#include "fem/elasticity/stiffness.hpp"
#include "fem/la/cholesky.hpp"
#include "fem/la/single_factor.hpp"

namespace codesign::fem {
namespace {

// A box held on x = 0, some nodes of it by two components only; coupled: nodes of two opposite
// faces, each face with itself.
struct Box {
  TetMesh mesh = box_mesh(5, 3, 2);
  Constraints constraints;
  CoupledNodes faces;

  Box() {
    constraints.fixed.assign(static_cast<std::size_t>(mesh.nodes.size()), 0);
    faces.groups.resize(2);
    for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) {
      const auto d = static_cast<std::size_t>(3 * n);
      const bool held = mesh.nodes(n, 0) == 0.0;
      constraints.fixed[d] = constraints.fixed[d + 1] = held;
      constraints.fixed[d + 2] = held || mesh.nodes(n, 2) == 0.0;
      if (mesh.nodes(n, 1) == 0.0) faces.groups[0].push_back(static_cast<int>(n));
      if (mesh.nodes(n, 1) == 1.0) faces.groups[1].push_back(static_cast<int>(n));
    }
  }

  NodePattern pattern(const CoupledNodes& coupled) const {
    return order_nodes(mesh, constraints, VertexOrdering::automatic, coupled);
  }

  LowerMatrix stiffness(const NodePattern& pattern) const {
    return assemble_stiffness(mesh, {"steel", 200e9, 0.3, 7800.0, 250e6}, pattern);
  }

  // Equations of the nodes' free components, ascending.
  static std::vector<int> equations(const NodePattern& pattern, const std::vector<int>& nodes) {
    std::vector<int> found;
    for (const int node : nodes)
      for (int d = 3 * node; d < 3 * node + 3; ++d)
        if (pattern.equation[static_cast<std::size_t>(d)] >= 0)
          found.push_back(pattern.equation[static_cast<std::size_t>(d)]);
    std::sort(found.begin(), found.end());
    return found;
  }
};

Eigen::MatrixXd dense(const LowerMatrix& a) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(a.size(), a.size());
  for (int j = 0; j < a.size(); ++j)
    for (int p = a.start[static_cast<std::size_t>(j)]; p < a.start[static_cast<std::size_t>(j + 1)];
         ++p)
      full(a.row[static_cast<std::size_t>(p)], j) = full(j, a.row[static_cast<std::size_t>(p)]) =
          a.value[static_cast<std::size_t>(p)];
  return full;
}

double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).norm() / b.norm();
}

TEST(SingleFactor, SolvesAsOneInDoublePrecision) {
  const Box box;
  const NodePattern pattern = box.pattern({});
  const LowerMatrix matrix = box.stiffness(pattern);
  const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(pattern.equations(), -1.0, 2.0);
  Eigen::MatrixXf x = load.cast<float>();
  const SingleFactor factor(pattern, matrix);
  factor.solve_lower(x);
  factor.solve_upper(x);
  const Eigen::VectorXd exact = CholeskyFactor(pattern, matrix).solve(load);
  EXPECT_LT(difference(x.cast<double>(), exact), 1e-5);
  EXPECT_LT(factor.bytes(), 5.0 * pattern.supernodes.entries);
}

// Against the Schur complement of the dense matrix; a load on all equations and a displacement of
// those that are left give the displacement of the others.
TEST(SingleFactor, LeavesTheLastEquations) {
  const Box box;
  const CoupledNodes last{{box.faces.groups[1]}, true};
  const NodePattern pattern = box.pattern(last);
  const Eigen::MatrixXd full = dense(box.stiffness(pattern));
  const std::vector<int> equations = Box::equations(pattern, last.groups[0]);
  const auto k = static_cast<Eigen::Index>(equations.size()), n = full.rows() - k;
  EXPECT_EQ(equations.front(), n);
  const SingleFactor factor(pattern, box.stiffness(pattern), static_cast<int>(k));
  const Eigen::MatrixXd inner = full.topLeftCorner(n, n).inverse();
  const Eigen::MatrixXd coupling = full.bottomLeftCorner(k, n);
  const Eigen::MatrixXd complement =
      full.bottomRightCorner(k, k) - coupling * inner * coupling.transpose();
  const Eigen::MatrixXd found = factor.complement().cast<double>().selfadjointView<Eigen::Lower>();
  EXPECT_LT(difference(found, complement), 1e-5);

  const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(n + k, -1.0, 2.0);
  Eigen::MatrixXf x = load.cast<float>();
  factor.solve_lower(x);
  EXPECT_LT(
      difference(x.bottomRows(k).cast<double>(), load.tail(k) - coupling * inner * load.head(n)),
      1e-5);
  const Eigen::VectorXd moved = 1e-9 * Eigen::VectorXd::LinSpaced(k, 1.0, 3.0);
  x.bottomRows(k) = moved.cast<float>();
  factor.solve_upper(x);
  EXPECT_LT(difference(x.topRows(n).cast<double>(),
                       inner * (load.head(n) - coupling.transpose() * moved)),
            1e-5);
}

TEST(SingleFactor, AddsBlocksBetweenCoupledNodes) {
  const Box box;
  const NodePattern pattern = box.pattern(box.faces);
  const LowerMatrix matrix = box.stiffness(pattern);
  Eigen::MatrixXd full = dense(matrix);
  std::vector<DenseBlock> blocks;
  for (const std::vector<int>& face : box.faces.groups) {
    const std::vector<int> equations = Box::equations(pattern, face);
    const auto k = static_cast<Eigen::Index>(equations.size());
    const Eigen::MatrixXd root = 1e5 * Eigen::MatrixXd::Random(k, k);
    const Eigen::MatrixXd block = root * root.transpose();
    full(equations, equations) += block;
    blocks.push_back({block.cast<float>(), equations});
  }
  const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(full.rows(), -1.0, 2.0);
  Eigen::MatrixXf x = load.cast<float>();
  const SingleFactor factor(pattern, matrix, 0, blocks);
  factor.solve_lower(x);
  factor.solve_upper(x);
  EXPECT_LT(difference(x.cast<double>(), full.lu().solve(load)), 1e-4);
}

TEST(SingleFactor, RefusesWhatIsNotPositiveDefinite) {
  Box box;
  box.constraints.fixed.assign(box.constraints.fixed.size(), 0);
  const NodePattern pattern = box.pattern({});
  LowerMatrix matrix = box.stiffness(pattern);
  matrix.value.front() *= -1.0;
  EXPECT_THROW(SingleFactor(pattern, matrix), SolverError);
}

}  // namespace
}  // namespace codesign::fem
