#include "fem/elasticity/buckling.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fem/boundary/rigid_motions.hpp"
#include "fem/elasticity/nodal_matrices.hpp"
#include "fem/elasticity/stiffness.hpp"
#include "fem/la/block_krylov.hpp"
#include "fem/la/lobpcg.hpp"
#include "fem/mesh/tet10.hpp"
#include "fem/stress/stress.hpp"
#include "interrupt.hpp"

namespace codesign::fem {

namespace {

constexpr double kTolerance = 1e-5;  // relative change of a factor; its error is far smaller
constexpr double kIterationTolerance = 1e-8;  // the same where changes shrink by a factor a round
constexpr double kVolumeShare = 0.01;
constexpr double kStressLimit = 0.25;  // of the shear modulus, see BucklingModes

// Magnitude of the stress tensor (Pa) exceeded in a share of the part: no singular point counts.
double bulk_stress(const TetMesh& mesh, const Material& material, const Eigen::VectorXd& u) {
  const PointStresses points = point_stresses(mesh, material, u);
  std::vector<std::pair<double, double>> samples;  // stress, volume
  for (Eigen::Index i = 0; i < points.stress.rows(); ++i) {
    const double normal = points.stress.row(i).head<3>().squaredNorm();
    const double shear = points.stress.row(i).tail<3>().squaredNorm();
    samples.emplace_back(std::sqrt(normal + 2.0 * shear), points.volume[i]);
  }
  std::sort(samples.begin(), samples.end(), std::greater<>());
  double left = kVolumeShare * points.volume.sum();
  for (const auto& [stress, volume] : samples) {
    left -= volume;
    if (left <= 0) return stress;
  }
  return samples.back().first;
}

Eigen::MatrixXd multiply_columns(const LowerMatrix& a, const Eigen::MatrixXd& x) {
  Eigen::MatrixXd y(x.rows(), x.cols());
  for (Eigen::Index k = 0; k < x.cols(); ++k) y.col(k) = multiply(a, x.col(k));
  return y;
}

// Mean stress (Pa) at which a shape of xᵀ K x = 1 buckles, its weight |grad x|²: small where the
// part turns more than it is strained.
double stress_of_mode(const TetMesh& mesh, const Eigen::VectorXd& shape) {
  double squares = 0.0;
  TetPoints points;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    check_interrupt();
    const TetNodes x = tet_nodes(mesh, e), u = tet_displacements(mesh, e, shape);
    evaluate_tet(x, stiffness_rule(x), points);
    for (int q = 0; q < points.count; ++q) {
      const std::size_t i = static_cast<std::size_t>(q);
      squares += points.weights[i] * (u * points.gradients[i].transpose()).squaredNorm();
    }
  }
  return 1.0 / squares;
}

// Reads the modes that count from the eigenpairs: `most` of the load, then one of it reversed.
void read_modes(const TetMesh& mesh, const NodePattern& pattern, const Eigenpairs& pairs,
                Eigen::Index most, double stress_limit, BucklingModes& modes) {
  const double negligible = 1.0 / modes.limit;
  const Eigen::MatrixXd shapes = nodal_columns(pattern, pairs.vectors);  // of xᵀ K x = 1
  const auto counts = [&](Eigen::Index k) {
    return std::abs(pairs.values[k]) > negligible &&
           stress_of_mode(mesh, shapes.col(k)) < stress_limit;
  };
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < most && pairs.values[k] > 0; ++k) {
    if (counts(k)) kept.push_back(k);
  }
  modes.factor = pairs.values(kept).cwiseInverse();
  modes.shape = shapes(Eigen::all, kept);
  for (auto shape : modes.shape.colwise()) {
    shape /= std::sqrt(shape.reshaped(3, mesh.nodes.rows()).colwise().squaredNorm().maxCoeff());
  }
  if (pairs.values[most] < 0 && counts(most)) modes.reversed = -1.0 / pairs.values[most];
  // Local modes have taken the places of those above them.
  const bool crowded = static_cast<Eigen::Index>(kept.size()) < most;
  if (crowded && pairs.values[most - 1] > negligible) modes.limit = 1.0 / pairs.values[most - 1];
}

// The modes of a load case; eigenpairs(u, wanted): of -K⁻¹ K_sigma, orthonormal in K.
template <class Eigensolver>
BucklingModes find_modes(const TetMesh& mesh, const Material& material, const NodePattern& pattern,
                         const Points& displacement, int count, const Eigensolver& eigenpairs) {
  if (count < 1) throw std::invalid_argument("count of modes must be >= 1");
  if (displacement.rows() != mesh.nodes.rows() || !displacement.allFinite()) {
    throw std::invalid_argument("the displacement needs three finite components for each node");
  }
  BucklingModes modes;
  modes.shape.resize(displacement.size(), 0);
  if (pattern.equations() == 0 || displacement.isZero(0.0)) return modes;
  const Eigen::Index most = std::min<Eigen::Index>(count, pattern.equations());
  const Eigen::VectorXd u =
      Eigen::Map<const Eigen::VectorXd>(displacement.data(), displacement.size());
  const double stress_limit = kStressLimit * shear_modulus(material);
  modes.limit = stress_limit / bulk_stress(mesh, material, u);
  const WantedEigenvalues wanted{
      .largest = most, .smallest = 1, .tolerance = kTolerance, .negligible = 1.0 / modes.limit};
  read_modes(mesh, pattern, eigenpairs(u, wanted), most, stress_limit, modes);
  return modes;
}

}  // namespace

BucklingModes buckling_of_factor(const TetMesh& mesh, const Material& material,
                                 const NodePattern& pattern, const CholeskyFactor& factor,
                                 const Points& displacement, int count) {
  const auto eigenpairs = [&](const Eigen::VectorXd& u, const WantedEigenvalues& wanted) {
    const Eigen::Index n = pattern.equations();
    const Eigen::Index block =
        std::min<Eigen::Index>(std::max(wanted.largest + 2, Eigen::Index{4}), n);
    const LowerMatrix stiffness = assemble_stiffness(mesh, material, pattern);
    const LowerMatrix geometric = assemble_geometric_stiffness(mesh, material, u, pattern);
    const auto apply = [&](const Eigen::MatrixXd& v, const Eigen::MatrixXd&) -> Eigen::MatrixXd {
      return -factor.solve(multiply_columns(geometric, v));
    };
    const auto inner = [&](const Eigen::VectorXd& x) { return multiply(stiffness, x); };
    return extreme_eigenpairs(inner, apply, factor.solve(random_block(n, block)), wanted);
  };
  return find_modes(mesh, material, pattern, displacement, count, eigenpairs);
}

BucklingModes buckling_by_iteration(const TetMesh& mesh, const Material& material,
                                    const NodePattern& pattern, const LowerMatrix& stiffness,
                                    const TwoLevelPreconditioner& preconditioner,
                                    const Points& displacement, int count) {
  const auto eigenpairs = [&](const Eigen::VectorXd& u, const WantedEigenvalues& wanted) {
    const LowerMatrix geometric = assemble_nodal_geometric_stiffness(mesh, material, u, pattern);
    // The largest of -K⁻¹ K_sigma are the least of K_sigma x = -value K x, and the reverse.
    const auto extreme = [&](double sign, Eigen::Index most) {
      const Eigen::Index n = pattern.equations();
      const SymmetricPencil pencil{
          [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
            return sign * multiply_nodal(pattern, geometric, x);
          },
          [&](const Eigen::VectorXd& x) { return multiply(stiffness, x); },
          [&](const Eigen::VectorXd& r) { return preconditioner.apply(r); }};
      Eigen::MatrixXd start = random_block(n, std::min<Eigen::Index>(most + 2, n));
      for (auto column : start.colwise()) column = preconditioner.apply(column);  // smooth
      WantedEigenvalues least = wanted;
      least.largest = 0;
      least.smallest = most;
      least.tolerance = kIterationTolerance;
      return lowest_eigenpairs(pencil, start, least);
    };
    const Eigenpairs load = extreme(1.0, wanted.largest);
    const Eigenpairs reversed = extreme(-1.0, wanted.smallest);
    Eigenpairs pairs{
        Eigen::VectorXd(load.values.size() + reversed.values.size()),
        Eigen::MatrixXd(load.vectors.rows(), load.vectors.cols() + reversed.vectors.cols())};
    pairs.values << -load.values, reversed.values;
    pairs.vectors << load.vectors, reversed.vectors;
    return pairs;
  };
  return find_modes(mesh, material, pattern, displacement, count, eigenpairs);
}

BucklingModes buckling_modes(const TetMesh& mesh, const Material& material,
                             const std::vector<Support>& supports, const Points& displacement,
                             int count, double memory_limit) {
  check_material(material);
  const Constraints constraints = constrain(mesh, supports);
  require_held(mesh, constraints);
  const NodePattern pattern = order_nodes(mesh, constraints);
  if (factor_fits(pattern, {memory_limit - eigen_bytes(pattern, count), kEigenOperations})) {
    const CholeskyFactor factor(pattern, assemble_stiffness(mesh, material, pattern));
    return buckling_of_factor(mesh, material, pattern, factor, displacement, count);
  }
  require_memory(matrix_bytes(pattern), memory_limit, static_cast<int>(mesh.nodes.rows()));
  const LowerMatrix stiffness = assemble_stiffness(mesh, material, pattern);
  const TwoLevelPreconditioner preconditioner(mesh, material, constraints, pattern, stiffness,
                                              memory_limit);
  return buckling_by_iteration(mesh, material, pattern, stiffness, preconditioner, displacement,
                               count);
}

}  // namespace codesign::fem
