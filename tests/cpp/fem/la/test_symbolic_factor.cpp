#include <cholmod.h>
#include <gtest/gtest.h>

#include <numeric>

#include "box_mesh.hpp"
#include "fem/elasticity/stiffness.hpp"
#include "fem/la/cholmod_view.hpp"
#include "fem/la/symbolic_factor.hpp"

namespace codesign::fem {
namespace {

struct Common : cholmod_common {
  Common() : cholmod_common() {
    cholmod_start(this);
    supernodal = CHOLMOD_SUPERNODAL;
    nmethods = 1;
    method[0].ordering = CHOLMOD_GIVEN;
    postorder = 0;
  }
  ~Common() { cholmod_finish(this); }
};

struct Problem {
  NodePattern pattern;
  LowerMatrix matrix;
  cholmod_sparse view{};

  Problem(const TetMesh& mesh, VertexOrdering method) {
    Constraints constraints;
    constraints.fixed.assign(static_cast<std::size_t>(mesh.nodes.size()), 0);
    for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) {
      const std::size_t d = static_cast<std::size_t>(3 * n);
      const bool held = mesh.nodes(n, 0) == 0.0;
      constraints.fixed[d] = constraints.fixed[d + 1] = held;
      constraints.fixed[d + 2] = held || mesh.nodes(n, 2) == 0.0;  // some nodes keep two components
    }
    pattern = order_nodes(mesh, constraints, method);
    matrix = assemble_stiffness(mesh, {"steel", 200e9, 0.3, 7800.0, 250e6}, pattern);
    view = cholmod_view(matrix);
  }
};

// The factor of a symbolic one, which is freed, as a dense lower triangle.
Eigen::MatrixXd lower_factor(Problem& problem, cholmod_factor* factor, Common& common) {
  double no_shift[2] = {0.0, 0.0};
  EXPECT_TRUE(cholmod_super_numeric(&problem.view, nullptr, no_shift, factor, &common));
  EXPECT_EQ(common.status, CHOLMOD_OK);
  EXPECT_TRUE(cholmod_check_factor(factor, &common));
  EXPECT_TRUE(cholmod_change_factor(CHOLMOD_REAL, 1, 0, 1, 1, factor, &common));  // columns of L
  const auto* start = static_cast<const int*>(factor->p);
  const auto* row = static_cast<const int*>(factor->i);
  const auto* value = static_cast<const double*>(factor->x);
  const auto n = static_cast<Eigen::Index>(factor->n);
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (int p = start[j]; p < start[j + 1]; ++p) L(row[p], j) = value[p];
  }
  cholmod_free_factor(&factor, &common);
  return L;
}

TEST(SymbolicFactor, GivesTheFactorOfCholmodsOwnAnalysis) {
  for (const VertexOrdering method :
       {VertexOrdering::minimum_degree, VertexOrdering::nested_dissection}) {
    for (const auto& [nx, ny, nz] : {std::array{1, 1, 1}, {3, 2, 1}, {4, 3, 3}}) {
      Problem problem(box_mesh(nx, ny, nz), method);
      Common common;
      std::vector<int> natural(problem.view.nrow);
      std::iota(natural.begin(), natural.end(), 0);
      const Eigen::MatrixXd ours =
          lower_factor(problem, symbolic_factor(problem.pattern, common), common);
      const Eigen::MatrixXd theirs = lower_factor(
          problem, cholmod_analyze_p(&problem.view, natural.data(), nullptr, 0, &common), common);
      EXPECT_LE((ours - theirs).norm(), 1e-12 * theirs.norm());
      EXPECT_GT(theirs.norm(), 0.0);
    }
  }
}

}  // namespace
}  // namespace codesign::fem
