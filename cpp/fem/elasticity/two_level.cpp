#include "fem/elasticity/two_level.hpp"

#include <cmath>

#include "fem/elasticity/memory.hpp"
#include "fem/elasticity/stiffness.hpp"
#include "fem/mesh/tet10.hpp"
#include "interrupt.hpp"

namespace codesign::fem {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// The corner nodes' pattern: to it, mid-edge nodes are held.
NodePattern corner_pattern(const TetMesh& mesh, Constraints constraints) {
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    for (int i = 4; i < kTetNodes; ++i) {
      for (std::size_t a = 0; a < 3; ++a) constraints.fixed[3 * at(mesh.tets(e, i)) + a] = 1;
    }
  }
  return order_nodes(mesh, constraints);
}

// x = (D + L)^-1 b with the lower triangle, diagonal included.
void solve_lower(const LowerMatrix& a, Eigen::VectorXd& x) {
  for (int j = 0; j < a.size(); ++j) {
    const int end = a.start[at(j) + 1];
    int p = a.start[at(j)];
    const double value = x[j] /= a.value[at(p)];
    for (++p; p < end; ++p) x[a.row[at(p)]] -= a.value[at(p)] * value;
  }
}

// x = (D + L^T)^-1 b
void solve_upper(const LowerMatrix& a, Eigen::VectorXd& x) {
  for (int j = a.size() - 1; j >= 0; --j) {
    const int begin = a.start[at(j)], end = a.start[at(j) + 1];
    double sum = x[j];
    for (int p = begin + 1; p < end; ++p) sum -= a.value[at(p)] * x[a.row[at(p)]];
    x[j] = sum / a.value[at(begin)];
  }
}

}  // namespace

TwoLevelPreconditioner::TwoLevelPreconditioner(const TetMesh& mesh, const Material& material,
                                               const Constraints& constraints,
                                               const NodePattern& pattern,
                                               const LowerMatrix& stiffness, double memory_limit,
                                               double shift)
    : stiffness_(stiffness),
      coarse_pattern_(corner_pattern(mesh, constraints)),
      parents_(at(pattern.equations())),
      coarse_((require_memory(matrix_bytes(pattern) + matrix_bytes(coarse_pattern_) +
                                  factor_bytes(coarse_pattern_),
                              memory_limit, static_cast<int>(mesh.nodes.rows())),
               coarse_pattern_),
              assemble_linear_stiffness(mesh, material, constraints, coarse_pattern_, shift)) {
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    for (int i = 0; i < kTetNodes; ++i) {
      for (int a = 0; a < 3; ++a) {
        const int fine = pattern.equation[3 * at(mesh.tets(e, i)) + at(a)];
        if (fine < 0) continue;
        const int first = i < 4 ? i : kTetEdges[i - 4][0], second = i < 4 ? i : kTetEdges[i - 4][1];
        parents_[at(fine)] = {coarse_pattern_.equation[3 * at(mesh.tets(e, first)) + at(a)],
                              coarse_pattern_.equation[3 * at(mesh.tets(e, second)) + at(a)]};
      }
    }
  }
}

double TwoLevelPreconditioner::bytes() const { return factor_bytes(coarse_pattern_); }

Eigen::VectorXd TwoLevelPreconditioner::apply(const Eigen::VectorXd& residual) const {
  Eigen::VectorXd x = residual;
  solve_lower(stiffness_, x);
  Eigen::VectorXd rest = residual - multiply(stiffness_, x);

  Eigen::VectorXd coarse = Eigen::VectorXd::Zero(coarse_pattern_.equations());
  for (std::size_t d = 0; d < parents_.size(); ++d) {
    const double half = 0.5 * rest[static_cast<Eigen::Index>(d)];
    if (parents_[d].first >= 0) coarse[parents_[d].first] += half;
    if (parents_[d].second >= 0) coarse[parents_[d].second] += half;
  }
  coarse = coarse_.solve(coarse).col(0);
  for (std::size_t d = 0; d < parents_.size(); ++d) {
    double& value = x[static_cast<Eigen::Index>(d)];
    if (parents_[d].first >= 0) value += 0.5 * coarse[parents_[d].first];
    if (parents_[d].second >= 0) value += 0.5 * coarse[parents_[d].second];
  }

  rest = residual - multiply(stiffness_, x);
  solve_upper(stiffness_, rest);
  return x + rest;
}

ConjugateGradientResult conjugate_gradients(const LowerMatrix& matrix,
                                            const TwoLevelPreconditioner& preconditioner,
                                            const Eigen::VectorXd& right_hand_side,
                                            double tolerance, int max_iterations) {
  ConjugateGradientResult result;
  result.solution = Eigen::VectorXd::Zero(right_hand_side.size());
  Eigen::VectorXd r = right_hand_side, z = preconditioner.apply(r), p = z;
  double rz = r.dot(z);
  const double target = tolerance * tolerance * rz;
  result.converged = rz <= 0.0;
  while (!result.converged && result.iterations < max_iterations) {
    check_interrupt();
    const Eigen::VectorXd ap = multiply(matrix, p);
    const double step = rz / p.dot(ap);
    if (!std::isfinite(step)) break;
    result.solution += step * p;
    r -= step * ap;
    ++result.iterations;
    z = preconditioner.apply(r);
    const double next = r.dot(z);
    result.converged = next <= target;
    p = z + (next / rz) * p;
    rz = next;
  }
  return result;
}

}  // namespace codesign::fem
