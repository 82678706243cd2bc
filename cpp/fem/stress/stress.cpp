#include "fem/stress/stress.hpp"

#include <algorithm>

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

double stress_of_volume(const TetMesh& mesh, const PointStresses& points,
                        const std::vector<int>& clamped, double distance, double volume) {
  const SurfaceDistance clamp(mesh, clamped);
  std::vector<std::pair<double, double>> samples;  // stress, volume
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
    for (int i = 0; i < 4; ++i) centroid += 0.25 * mesh.nodes.row(mesh.tets(e, i)).transpose();
    if (clamp.within(centroid, distance)) continue;
    for (int q = 4 * e; q < 4 * e + 4; ++q) {
      samples.emplace_back(von_mises(Voigt(points.stress.row(q).transpose())), points.volume[q]);
    }
  }
  std::sort(samples.begin(), samples.end(), std::greater<>());
  double above = 0.0;
  for (const auto& [stress, share] : samples) {
    above += share;
    if (above >= volume) return stress;
  }
  return samples.empty() ? 0.0 : samples.back().first;
}

}  // namespace codesign::fem
