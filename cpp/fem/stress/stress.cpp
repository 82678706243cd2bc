#include "fem/stress/stress.hpp"

#include <algorithm>
#include <compare>
#include <functional>
#include <vector>

#include "fem/mesh/tet10.hpp"
#include "fem/stress/surface_distance.hpp"

namespace codesign::fem {

PointStresses point_stresses(const TetMesh& mesh, const Material& material,
                             const Eigen::VectorXd& displacement) {
  const double lambda = lame_lambda(material), mu = shear_modulus(material);
  PointStresses result;
  result.stress.resize(4 * mesh.tets.rows(), 6);
  result.volume.resize(4 * mesh.tets.rows());
  TetPoints points;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    evaluate_tet(tet_nodes(mesh, e), tet_rule_4(), points);
    const TetNodes u = tet_displacements(mesh, e, displacement);
    for (int q = 0; q < 4; ++q) {
      const Eigen::Matrix3d h = u * points.gradients[static_cast<std::size_t>(q)].transpose();
      result.stress.row(4 * e + q) = stress_of_gradient(lambda, mu, h).transpose();
      result.volume[4 * e + q] = points.weights[static_cast<std::size_t>(q)];
    }
  }
  return result;
}

Eigen::VectorXd von_mises(const Stresses& stress) {
  Eigen::VectorXd result(stress.rows());
  for (Eigen::Index i = 0; i < stress.rows(); ++i) {
    result[i] = von_mises(Voigt(stress.row(i).transpose()));
  }
  return result;
}

namespace {

// Of an integration point; ordered by stress.
struct Sample {
  double stress, volume;
  int element;
  auto operator<=>(const Sample&) const = default;
};

Eigen::Vector3d centroid(const TetMesh& mesh, int element) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < 4; ++i) sum += 0.25 * mesh.nodes.row(mesh.tets(element, i)).transpose();
  return sum;
}

}  // namespace

double stress_of_volume(const TetMesh& mesh, const PointStresses& points,
                        const std::vector<int>& clamped, double distance, double volume) {
  const SurfaceDistance clamp(mesh, clamped);
  std::vector<Sample> samples;
  samples.reserve(static_cast<std::size_t>(points.volume.size()));
  for (int q = 0; q < points.volume.size(); ++q) {
    samples.push_back(
        {von_mises(Voigt(points.stress.row(q).transpose())), points.volume[q], q / 4});
  }
  std::sort(samples.begin(), samples.end(), std::greater<>());
  double above = 0.0, lowest = 0.0;
  for (const Sample& sample : samples) {
    if (clamp.within(centroid(mesh, sample.element), distance)) continue;
    lowest = sample.stress;
    above += sample.volume;
    if (above >= volume) break;
  }
  return lowest;
}

}  // namespace codesign::fem
