#include "fem/elasticity/natural_modes.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fem/boundary/rigid_motions.hpp"
#include "fem/la/block_krylov.hpp"

namespace codesign::fem {

namespace {

constexpr double kPi = 3.14159265358979323846;

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
  const Eigenpairs pairs = extreme_eigenpairs(
      mass, [&](const Eigen::MatrixXd&, const Eigen::MatrixXd& mv) { return factor.solve(mv); },
      factor.solve(random_block(n, block)), {.largest = wanted});
  NaturalModes modes{Eigen::VectorXd(wanted), nodal_columns(pattern, pairs.vectors)};
  for (Eigen::Index k = 0; k < wanted; ++k) {  // the largest value is the lowest frequency
    const double square = 1.0 / pairs.values[k] - shift;
    modes.frequency[k] = square > 1e-6 * shift ? std::sqrt(square) / (2.0 * kPi) : 0.0;
  }
  return modes;
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
