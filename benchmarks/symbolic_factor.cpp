// Our symbolic factorization of the nodes against cholmod_analyze_p of the equations in the same
// order, on a model that benchmarks/symbolic_factor.py has written:
//   benchmark_symbolic_factor MODEL REPEATS
// Prints one line of JSON: CPU seconds (least of REPEATS, the two in turns) and sizes.
#include "fem/la/symbolic_factor.hpp"

#include <cholmod.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "fem/elasticity/stiffness.hpp"
#include "fem/la/cholmod_view.hpp"
#include "model_file.hpp"

extern "C" void openblas_set_num_threads(int threads) __attribute__((weak));

namespace {

using namespace codesign::fem;

struct Times {
  double analysis = std::numeric_limits<double>::infinity(), factor = analysis, solve = analysis;
};

struct Common : cholmod_common {
  Common() : cholmod_common() {
    cholmod_start(this);
    supernodal = CHOLMOD_SUPERNODAL;
    nmethods = 1;
    method[0].ordering = CHOLMOD_GIVEN;
    quick_return_if_not_posdef = 1;
  }
  ~Common() { cholmod_finish(this); }
};

// Numeric factor and solution with a symbolic factor, which is freed.
Eigen::VectorXd solve(cholmod_sparse& a, cholmod_factor* factor, Common& common, Times& times,
                      double& entries) {
  timed(times.factor, [&] { return cholmod_factorize(&a, factor, &common); });
  if (common.status != CHOLMOD_OK) throw std::runtime_error("no factor");
  entries = static_cast<double>(factor->xsize);
  cholmod_dense* ones = cholmod_ones(a.nrow, 1, CHOLMOD_REAL, &common);
  cholmod_dense* x =
      timed(times.solve, [&] { return cholmod_solve(CHOLMOD_A, factor, ones, &common); });
  const Eigen::VectorXd result = Eigen::Map<const Eigen::VectorXd>(
      static_cast<const double*>(x->x), static_cast<Eigen::Index>(a.nrow));
  cholmod_free_dense(&x, &common);
  cholmod_free_dense(&ones, &common);
  cholmod_free_factor(&factor, &common);
  return result;
}

Eigen::VectorXd nodal(const NodePattern& pattern, const Eigen::VectorXd& x) {
  return nodal_columns(pattern, x).col(0);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  if (openblas_set_num_threads) openblas_set_num_threads(1);
  const Model model = read_model(argv[1]);
  const Material material{"steel", 200e9, 0.3, 7800.0, 250e6};
  const NodePattern ordered = fill_reducing_order(model.mesh, model.constraints);
  const NodePattern grouped = order_nodes(model.mesh, model.constraints);
  const LowerMatrix matrix = assemble_stiffness(model.mesh, material, ordered);
  const LowerMatrix grouped_matrix = assemble_stiffness(model.mesh, material, grouped);
  cholmod_sparse a = cholmod_view(matrix), grouped_a = cholmod_view(grouped_matrix);
  std::vector<int> natural(a.nrow);
  std::iota(natural.begin(), natural.end(), 0);

  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Times ours, theirs;
  double order = kInfinity, order_and_group = kInfinity, symbolic = kInfinity;
  double our_entries = 0, their_entries = 0, difference = 0;
  for (int repeat = 0; repeat < std::atoi(argv[2]); ++repeat) {
    Common common;
    timed(order, [&] { return fill_reducing_order(model.mesh, model.constraints); });
    timed(order_and_group, [&] { return order_nodes(model.mesh, model.constraints); });
    cholmod_factor* factor = timed(symbolic, [&] { return symbolic_factor(grouped, common); });
    const Eigen::VectorXd x = solve(grouped_a, factor, common, ours, our_entries);
    factor = timed(theirs.analysis,
                   [&] { return cholmod_analyze_p(&a, natural.data(), nullptr, 0, &common); });
    const Eigen::VectorXd y = solve(a, factor, common, theirs, their_entries);
    difference = (nodal(grouped, x) - nodal(ordered, y)).norm() / x.norm();
  }
  ours.analysis = order_and_group - order + symbolic;
  const auto print = [](const char* name, const Times& t, double entries) {
    std::printf(
        "\"%s\": {\"analysis\": %.5f, \"factor\": %.5f, \"solve\": %.5f, \"entries\": %.0f}, ",
        name, t.analysis, t.factor, t.solve, entries);
  };
  std::printf("{\"equations\": %d, \"order\": %.5f, ", grouped.equations(), order);
  print("ours", ours, our_entries);
  print("cholmod", theirs, their_entries);
  std::printf("\"difference\": %.2e}\n", difference);
}
