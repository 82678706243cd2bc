#include "fem/elasticity/natural_modes.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fem/boundary/rigid_motions.hpp"
#include "fem/elasticity/nodal_matrices.hpp"
#include "fem/la/block_krylov.hpp"
#include "fem/la/lobpcg.hpp"
#include "model_error.hpp"

namespace codesign::fem {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kBlocks = 16.0;     // of vectors: the basis and its products, with room to grow
constexpr double kTolerance = 1e-9;  // relative change of an eigenvalue in a round of iteration

// K + shift M, in place.
void add_mass(double shift, const LowerMatrix& mass, LowerMatrix& stiffness) {
  for (std::size_t i = 0; i < mass.value.size(); ++i) stiffness.value[i] += shift * mass.value[i];
}

// A product with the mass matrix of the mesh, and what the masses carried by it add.
Eigen::VectorXd with_carried(Eigen::VectorXd product, const Eigen::MatrixXd& carried,
                             const Eigen::VectorXd& x) {
  if (carried.cols() > 0) product.noalias() += carried * (carried.transpose() * x);
  return product;
}

// pairs: of (K + shift M) x = value M x, ascending.
NaturalModes read_modes(const NodePattern& pattern, const Eigenpairs& pairs, double shift) {
  NaturalModes modes{Eigen::VectorXd(pairs.values.size()), nodal_columns(pattern, pairs.vectors)};
  for (Eigen::Index k = 0; k < pairs.values.size(); ++k) {
    const double square = pairs.values[k] - shift;
    modes.frequency[k] = square > 1e-6 * shift ? std::sqrt(square) / (2.0 * kPi) : 0.0;
  }
  return modes;
}

}  // namespace

double eigen_bytes(const NodePattern& pattern, int count) {
  const double columns = kBlocks * std::max(count + 2, 4);
  return matrix_bytes(pattern) + columns * pattern.equations() * sizeof(double);
}

Eigen::MatrixXd carried_columns(const TetMesh& mesh, const NodePattern& pattern,
                                const std::vector<RemoteMass>& masses) {
  const Eigen::MatrixXd nodal = mass_columns(mesh, masses);
  Eigen::MatrixXd free(pattern.equations(), nodal.cols());
  for (std::size_t d = 0; d < pattern.equation.size(); ++d) {
    if (pattern.equation[d] >= 0) {
      free.row(pattern.equation[d]) = nodal.row(static_cast<Eigen::Index>(d));
    }
  }
  return free;
}

NaturalModes modes_of_factor(const NodePattern& pattern, const LowerMatrix& mass,
                             const Eigen::MatrixXd& carried, const CholeskyFactor& factor,
                             double shift, int count) {
  if (count < 1) throw std::invalid_argument("count of modes must be >= 1");
  const Eigen::Index n = pattern.equations();
  const Eigen::Index wanted = std::min<Eigen::Index>(count, n);
  const Eigen::Index block = std::min<Eigen::Index>(std::max(wanted + 2, Eigen::Index{4}), n);
  const auto inner = [&](const Eigen::VectorXd& x) {
    return with_carried(multiply(mass, x), carried, x);
  };
  const Eigenpairs pairs = extreme_eigenpairs(
      inner, [&](const Eigen::MatrixXd&, const Eigen::MatrixXd& mv) { return factor.solve(mv); },
      factor.solve(random_block(n, block)), {.largest = wanted});
  return read_modes(pattern, {pairs.values.cwiseInverse(), pairs.vectors}, shift);
}

NaturalModes modes_by_iteration(const NodePattern& pattern, const LowerMatrix& nodal_mass,
                                const Eigen::MatrixXd& carried, const LowerMatrix& stiffness,
                                const TwoLevelPreconditioner& preconditioner, double shift,
                                int count) {
  if (count < 1) throw std::invalid_argument("count of modes must be >= 1");
  const Eigen::Index n = pattern.equations();
  const Eigen::Index wanted = std::min<Eigen::Index>(count, n);
  const SymmetricPencil pencil{[&](const Eigen::VectorXd& x) { return multiply(stiffness, x); },
                               [&](const Eigen::VectorXd& x) {
                                 return with_carried(multiply_nodal(pattern, nodal_mass, x),
                                                     carried, x);
                               },
                               [&](const Eigen::VectorXd& r) { return preconditioner.apply(r); }};
  Eigen::MatrixXd start = random_block(n, std::min<Eigen::Index>(wanted + 2, n));
  for (auto column : start.colwise()) column = preconditioner.apply(column);  // smooth
  return read_modes(
      pattern,
      lowest_eigenpairs(pencil, start, {.largest = 0, .smallest = wanted, .tolerance = kTolerance}),
      shift);
}

NaturalModes natural_modes(const TetMesh& mesh, const Material& material,
                           const std::vector<Support>& supports, int count, double memory_limit,
                           const std::vector<RemoteMass>& masses) {
  check_material(material);
  if (!(material.density > 0)) throw std::invalid_argument("modes need a density above 0");
  if (count < 1) throw std::invalid_argument("count of modes must be >= 1");
  const Constraints constraints = constrain(mesh, supports);
  const NodePattern pattern = order_nodes(mesh, constraints);
  double shift = 0.0;
  if (!free_rigid_motions(mesh, constraints).empty()) {
    const double length = extent(mesh.nodes);
    if (!masses.empty()) throw ModelError("modes with remote masses need a part that is held");
    shift = 0.01 * material.young_modulus / (material.density * length * length);
  }
  check_masses(masses);
  const Eigen::MatrixXd carried = carried_columns(mesh, pattern, masses);
  if (factor_fits(pattern, {memory_limit - eigen_bytes(pattern, count), kEigenOperations})) {
    const LowerMatrix mass = assemble_mass(mesh, material, pattern);
    LowerMatrix stiffness = assemble_stiffness(mesh, material, pattern);
    if (shift > 0.0) add_mass(shift, mass, stiffness);
    const CholeskyFactor factor(pattern, stiffness);
    stiffness = {};
    return modes_of_factor(pattern, mass, carried, factor, shift, count);
  }
  require_memory(matrix_bytes(pattern), memory_limit, static_cast<int>(mesh.nodes.rows()));
  const LowerMatrix mass = assemble_nodal_mass(mesh, material, pattern);
  LowerMatrix stiffness = assemble_stiffness(mesh, material, pattern);
  if (shift > 0.0) add_nodal(shift, mass, pattern, stiffness);
  const TwoLevelPreconditioner preconditioner(mesh, material, constraints, pattern, stiffness,
                                              memory_limit, shift);
  return modes_by_iteration(pattern, mass, carried, stiffness, preconditioner, shift, count);
}

}  // namespace codesign::fem
