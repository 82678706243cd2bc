#include "fem/buckling.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "fem/block_krylov.hpp"
#include "fem/rigid_motions.hpp"
#include "fem/stiffness.hpp"
#include "fem/stress.hpp"

namespace codesign::fem {

namespace {

constexpr double kTolerance = 1e-6;  // relative change of a factor
constexpr double kVolumeShare = 0.01;
constexpr double kStressLimit = 0.25;  // of the shear modulus

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

}  // namespace

BucklingModes buckling_of_factor(const TetMesh& mesh, const Material& material,
                                 const NodePattern& pattern, const CholeskyFactor& factor,
                                 const Points& displacement, int count) {
  if (count < 1) throw std::invalid_argument("count of modes must be >= 1");
  if (displacement.rows() != mesh.nodes.rows() || !displacement.allFinite()) {
    throw std::invalid_argument("the displacement needs three finite components for each node");
  }
  BucklingModes modes;
  modes.shape.resize(displacement.size(), 0);
  if (pattern.equations() == 0 || displacement.isZero(0.0)) return modes;
  const Eigen::Index n = pattern.equations();
  const Eigen::Index most = std::min<Eigen::Index>(count, n);
  const Eigen::Index block = std::min<Eigen::Index>(std::max(most + 2, Eigen::Index{4}), n);
  const Eigen::VectorXd u =
      Eigen::Map<const Eigen::VectorXd>(displacement.data(), displacement.size());
  modes.limit = kStressLimit * shear_modulus(material) / bulk_stress(mesh, material, u);
  const LowerMatrix stiffness = assemble_stiffness(mesh, material, pattern);
  const LowerMatrix geometric = assemble_geometric_stiffness(mesh, material, u, pattern);
  const auto apply = [&](const Eigen::MatrixXd& v, const Eigen::MatrixXd&) -> Eigen::MatrixXd {
    return -factor.solve(multiply_columns(geometric, v));
  };
  const WantedEigenvalues wanted{
      .largest = most, .smallest = 1, .tolerance = kTolerance, .negligible = 1.0 / modes.limit};
  const Eigenpairs pairs =
      extreme_eigenpairs(stiffness, apply, factor.solve(random_block(n, block)), wanted);
  const Eigen::Index found = (pairs.largest.array() > wanted.negligible).count();
  modes.factor = pairs.largest.head(found).cwiseInverse();
  modes.shape = nodal_columns(pattern, pairs.vectors.leftCols(found));
  for (Eigen::Index k = 0; k < found; ++k) {
    const Eigen::Map<const Points> moved(modes.shape.col(k).data(), mesh.nodes.rows(), 3);
    modes.shape.col(k) /= moved.rowwise().norm().maxCoeff();
  }
  if (pairs.smallest[0] < -wanted.negligible) modes.reversed = -1.0 / pairs.smallest[0];
  return modes;
}

BucklingModes buckling_modes(const TetMesh& mesh, const Material& material,
                             const std::vector<Support>& supports, const Points& displacement,
                             int count) {
  check_material(material);
  const Constraints constraints = constrain(mesh, supports);
  require_held(mesh, constraints);
  const NodePattern pattern = order_nodes(mesh, constraints);
  const CholeskyFactor factor(pattern, assemble_stiffness(mesh, material, pattern));
  return buckling_of_factor(mesh, material, pattern, factor, displacement, count);
}

}  // namespace codesign::fem
