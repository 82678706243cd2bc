// Our block Lanczos method against Spectra's implicitly restarted one (both shift-invert with our
// factor, inner product of the mass), on a model that benchmarks/eigensolver.py has written:
//   benchmark_eigensolver MODEL MODES REPEATS
// Prints one line of JSON: CPU seconds (least of REPEATS, in turns) without the factor, largest
// relative difference of a frequency, largest relative residual of each.
#include <Spectra/SymGEigsShiftSolver.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "fem/elasticity/natural_modes.hpp"
#include "fem/elasticity/stiffness.hpp"
#include "fem/la/block_krylov.hpp"
#include "model_file.hpp"

namespace {

using namespace codesign::fem;

struct InverseStiffness {
  using Scalar = double;
  const CholeskyFactor& factor;
  Eigen::Index rows() const { return size; }
  Eigen::Index cols() const { return size; }
  void set_shift(double) {}
  void perform_op(const double* x, double* y) const {
    Eigen::Map<Eigen::VectorXd>(y, size) = factor.solve(Eigen::Map<const Eigen::VectorXd>(x, size));
  }
  Eigen::Index size;
};

struct Mass {
  using Scalar = double;
  const LowerMatrix& matrix;
  Eigen::Index rows() const { return matrix.size(); }
  Eigen::Index cols() const { return matrix.size(); }
  void perform_op(const double* x, double* y) const {
    Eigen::Map<Eigen::VectorXd>(y, rows()) =
        multiply(matrix, Eigen::Map<const Eigen::VectorXd>(x, rows()));
  }
};

// Largest |K x - λ M x| / |K x| of pairs of eigenvalues and vectors.
double residual(const LowerMatrix& stiffness, const LowerMatrix& mass,
                const Eigen::VectorXd& values, const Eigen::MatrixXd& vectors) {
  double worst = 0.0;
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    const Eigen::VectorXd x = vectors.col(k), kx = multiply(stiffness, x);
    worst = std::max(worst, (kx - values[k] * multiply(mass, x)).norm() / kx.norm());
  }
  return worst;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const Model model = read_model(argv[1]);
  const int modes = std::atoi(argv[2]);
  const Material material{"steel", 200e9, 0.3, 7800.0, 250e6};
  const NodePattern pattern = order_nodes(model.mesh, model.constraints);
  const LowerMatrix stiffness = assemble_stiffness(model.mesh, material, pattern);
  const LowerMatrix mass = assemble_mass(model.mesh, material, pattern);
  const CholeskyFactor factor(pattern, stiffness);
  const Eigen::Index n = pattern.equations(), block = std::max(modes + 2, 4);

  double ours = std::numeric_limits<double>::infinity(), theirs = ours;
  Eigenpairs pairs;
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
  for (int repeat = 0; repeat < std::atoi(argv[3]); ++repeat) {
    pairs = timed(ours, [&] {
      return extreme_eigenpairs(
          [&](const Eigen::VectorXd& x) { return multiply(mass, x); },
          [&](const Eigen::MatrixXd&, const Eigen::MatrixXd& mv) { return factor.solve(mv); },
          factor.solve(random_block(n, block)), {.largest = modes});
    });
    InverseStiffness inverse{factor, n};
    Mass inner{mass};
    Spectra::SymGEigsShiftSolver<InverseStiffness, Mass, Spectra::GEigsMode::ShiftInvert> solver(
        inverse, inner, modes, 2 * modes + 4, 0.0);
    const auto found = timed(theirs, [&] {
      solver.init();
      return solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-9,
                            Spectra::SortRule::SmallestAlge);
    });
    if (found < modes) return 1;
    values = solver.eigenvalues();
    vectors = solver.eigenvectors();
  }
  const Eigen::VectorXd inverse_values = pairs.values.cwiseInverse();
  const double difference =
      ((inverse_values - values).array() / values.array()).abs().maxCoeff() / 2.0;
  std::printf(
      "{\"equations\": %ld, \"ours\": %.4f, \"spectra\": %.4f, \"difference\": %.1e, "
      "\"residuals\": [%.1e, %.1e]}\n",
      static_cast<long>(n), ours, theirs, difference,
      residual(stiffness, mass, inverse_values, pairs.vectors),
      residual(stiffness, mass, values, vectors));
}
