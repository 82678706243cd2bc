#include "fem/elasticity/condensed_solution.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "fem/elasticity/stiffness.hpp"

namespace codesign::fem {
namespace {

constexpr int kMaxSteps = 12;

// One column of the work.
struct Descent {
  Eigen::Index column;
  double scale;  // N, of the residual
  double last = 0.0;
};

}  // namespace

Eigen::MatrixXd condensed_solution(const CondensedFactor& factor, const TetMesh& mesh,
                                   const Material& material, const Constraints& constraints,
                                   const Eigen::MatrixXd& loads, double tolerance) {
  Eigen::MatrixXd u = constraints.displacement.replicate(1, loads.cols());
  Eigen::MatrixXd residual = loads;
  if (!constraints.displacement.isZero(0.0))
    residual.colwise() -=
        Eigen::VectorXd(internal_forces(mesh, material, constraints.displacement).sum);
  residual = felt(constraints, std::move(residual));
  std::vector<Descent> active;
  for (Eigen::Index i = 0; i < loads.cols(); ++i)
    if (!residual.col(i).isZero(0.0)) active.push_back({i, loads.col(i).norm()});
  Eigen::MatrixXd direction(u.rows(), u.cols());
  for (int step = 0; step < kMaxSteps && !active.empty(); ++step) {
    std::vector<Eigen::Index> columns;
    for (const Descent& descent : active) columns.push_back(descent.column);
    const Eigen::MatrixXd preconditioned = factor.solve(residual(Eigen::all, columns));
    for (std::size_t k = 0; k < active.size(); ++k) {
      auto way = direction.col(columns[k]);
      const auto steepest = preconditioned.col(static_cast<Eigen::Index>(k));
      const double now = residual.col(columns[k]).dot(steepest);
      if (step == 0)
        way = steepest;
      else
        way = steepest + now / active[k].last * way;
      active[k].last = now;
    }
    InternalForces forces = internal_forces(mesh, material, direction(Eigen::all, columns));
    forces.sum = felt(constraints, std::move(forces.sum));
    for (std::size_t k = 0; k < active.size(); ++k) {
      const auto way = direction.col(columns[k]);
      const auto resisted = forces.sum.col(static_cast<Eigen::Index>(k));
      const double length = active[k].last / way.dot(resisted);
      u.col(columns[k]) += length * way;
      residual.col(columns[k]) -= length * resisted;
      if (step == 0)
        active[k].scale = std::max(active[k].scale,
                                   length * forces.size.col(static_cast<Eigen::Index>(k)).norm());
    }
    active.erase(std::remove_if(active.begin(), active.end(),
                                [&](const Descent& descent) {
                                  return residual.col(descent.column).norm() <=
                                         tolerance * descent.scale;
                                }),
                 active.end());
  }
  return u;
}

}  // namespace codesign::fem
