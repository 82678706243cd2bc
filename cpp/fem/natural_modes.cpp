#include "fem/natural_modes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "errors.hpp"
#include "fem/rigid_motions.hpp"

namespace codesign::fem {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kTolerance = 1e-9;  // relative change of an eigenvalue
constexpr int kMaxBlocks = 40;

// Vectors that are orthonormal in the mass's inner product, with their products with the mass.
struct Basis {
  const LowerMatrix& mass;
  Eigen::MatrixXd v, mv;
  Eigen::Index size = 0;

  // Adds what a vector holds beyond the basis; nothing if that is rounding.
  void add(Eigen::VectorXd x) {
    const double before = std::sqrt(std::abs(x.dot(multiply(mass, x))));
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd along = mv.leftCols(size).transpose() * x;
      x.noalias() -= v.leftCols(size) * along;
    }
    const Eigen::VectorXd mx = multiply(mass, x);
    const double norm = std::sqrt(std::abs(x.dot(mx)));
    if (!(norm > 1e-10 * before)) return;
    if (size == v.cols()) {
      v.conservativeResize(Eigen::NoChange, 2 * size);
      mv.conservativeResize(Eigen::NoChange, 2 * size);
    }
    v.col(size) = x / norm;
    mv.col(size++) = mx / norm;
  }
};

Eigen::MatrixXd random_block(Eigen::Index rows, Eigen::Index columns) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::MatrixXd block(rows, columns);
  for (Eigen::Index i = 0; i < block.size(); ++i) block.data()[i] = uniform(generator);
  return block;
}

// K + shift M, in place.
void add_mass(double shift, const LowerMatrix& mass, LowerMatrix& stiffness) {
  for (std::size_t i = 0; i < mass.value.size(); ++i) stiffness.value[i] += shift * mass.value[i];
}

}  // namespace

NaturalModes modes_of_factor(const NodePattern& pattern, const LowerMatrix& mass,
                             const CholeskyFactor& factor, double shift, int count) {
  if (count < 1) throw std::invalid_argument("count of modes must be >= 1");
  const Eigen::Index n = pattern.equations();
  const Eigen::Index wanted = std::min<Eigen::Index>(count, n);
  const Eigen::Index block = std::min<Eigen::Index>(std::max(wanted + 2, Eigen::Index{4}), n);
  Basis basis{mass, Eigen::MatrixXd(n, 6 * block), Eigen::MatrixXd(n, 6 * block)};
  Eigen::MatrixXd next = factor.solve(random_block(n, block));
  Eigen::MatrixXd projected;
  Eigen::VectorXd last = Eigen::VectorXd::Zero(wanted);
  for (int step = 0; step < kMaxBlocks; ++step) {
    const Eigen::Index before = basis.size;
    for (Eigen::Index k = 0; k < next.cols(); ++k) basis.add(next.col(k));
    const Eigen::Index added = basis.size - before;
    if (added > 0) {
      next = factor.solve(basis.mv.middleCols(before, added));
      projected.conservativeResize(basis.size, basis.size);
      projected.rightCols(added) = basis.mv.leftCols(basis.size).transpose() * next;
      projected.bottomLeftCorner(added, before) =
          projected.topRightCorner(before, added).transpose();
    }
    if (basis.size < wanted) break;
    const Eigen::MatrixXd symmetric = 0.5 * (projected + projected.transpose());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz(symmetric);
    const Eigen::VectorXd value = ritz.eigenvalues().tail(wanted);
    const bool still = ((value - last).array().abs() <= kTolerance * value.array()).all();
    last = value;
    if (!still && added > 0) continue;

    NaturalModes modes{
        Eigen::VectorXd(wanted),
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(pattern.equation.size()), wanted)};
    for (Eigen::Index k = 0; k < wanted; ++k) {  // the largest value is the lowest frequency
      const Eigen::Index column = basis.size - 1 - k;
      const double square = 1.0 / ritz.eigenvalues()[column] - shift;
      modes.frequency[k] = square > 1e-6 * shift ? std::sqrt(square) / (2.0 * kPi) : 0.0;
      const Eigen::VectorXd x = basis.v.leftCols(basis.size) * ritz.eigenvectors().col(column);
      for (std::size_t d = 0; d < pattern.equation.size(); ++d) {
        if (pattern.equation[d] >= 0) {
          modes.shape(static_cast<Eigen::Index>(d), k) = x[pattern.equation[d]];
        }
      }
    }
    return modes;
  }
  throw SolverError("the natural frequencies have not converged");
}

NaturalModes natural_modes(const TetMesh& mesh, const Material& material,
                           const std::vector<Support>& supports, int count) {
  check_material(material);
  if (!(material.density > 0)) throw std::invalid_argument("modes need a density above 0");
  const Constraints constraints = constrain(mesh, supports);
  const NodePattern pattern = order_nodes(mesh, constraints);
  const LowerMatrix mass = assemble_mass(mesh, material, pattern);
  LowerMatrix stiffness = assemble_stiffness(mesh, material, pattern);
  double shift = 0.0;
  if (!free_rigid_motions(mesh, constraints).empty()) {
    const double length = extent(mesh.nodes);
    shift = 0.01 * material.young_modulus / (material.density * length * length);
    add_mass(shift, mass, stiffness);
  }
  const CholeskyFactor factor(pattern, stiffness);
  return modes_of_factor(pattern, mass, factor, shift, count);
}

}  // namespace codesign::fem
