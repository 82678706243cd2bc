#include "fem/stress.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>

#include "fem/surface_distance.hpp"
#include "fem/tet10.hpp"

namespace codesign::fem {

namespace {

// Linear extrapolation from the four points to the ten nodes: rows nodes, columns points.
Eigen::Matrix<double, 10, 4> extrapolation() {
  Eigen::Matrix4d at_points;
  const TetRule& rule = tet_rule_4();
  for (int q = 0; q < 4; ++q) {
    const Eigen::Vector3d& p = rule.points[static_cast<std::size_t>(q)];
    at_points.row(q) << 1.0 - p.sum(), p.transpose();
  }
  Eigen::Matrix<double, 10, 4> at_nodes = Eigen::Matrix<double, 10, 4>::Zero();
  at_nodes.topRows<4>().setIdentity();
  for (int k = 0; k < 6; ++k) {
    at_nodes(4 + k, kTetEdges[k][0]) = 0.5;
    at_nodes(4 + k, kTetEdges[k][1]) = 0.5;
  }
  return at_nodes * at_points.inverse();
}

}  // namespace

PointStresses point_stresses(const TetMesh& mesh, const Material& material,
                             const Eigen::VectorXd& displacement) {
  const double lambda = lame_lambda(material), mu = shear_modulus(material);
  PointStresses result;
  result.stress.resize(4 * mesh.tets.rows(), 6);
  result.volume.resize(4 * mesh.tets.rows());
  TetPoints points;
  TetNodes u;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    evaluate_tet(tet_nodes(mesh, e), tet_rule_4(), points);
    for (int i = 0; i < kTetNodes; ++i) u.col(i) = displacement.segment<3>(3 * mesh.tets(e, i));
    for (int q = 0; q < 4; ++q) {
      const Eigen::Matrix3d h = u * points.gradients[static_cast<std::size_t>(q)].transpose();
      Voigt strain;
      strain << h(0, 0), h(1, 1), h(2, 2), h(0, 1) + h(1, 0), h(1, 2) + h(2, 1), h(2, 0) + h(0, 2);
      result.stress.row(4 * e + q) = stress_of_strain(lambda, mu, strain).transpose();
      result.volume[4 * e + q] = points.weights[static_cast<std::size_t>(q)];
    }
  }
  return result;
}

Stresses recover_stress(const TetMesh& mesh, const PointStresses& points) {
  const Eigen::Matrix<double, 10, 4> to_nodes = extrapolation();
  Stresses sum = Stresses::Zero(mesh.nodes.rows(), 6);
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(mesh.nodes.rows());
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    const double volume = points.volume.segment<4>(4 * e).sum();
    const Eigen::Matrix<double, 10, 6> nodal = to_nodes * points.stress.middleRows<4>(4 * e);
    for (int i = 0; i < kTetNodes; ++i) {
      sum.row(mesh.tets(e, i)) += volume * nodal.row(i);
      weight[mesh.tets(e, i)] += volume;
    }
  }
  for (Eigen::Index n = 0; n < sum.rows(); ++n) {
    if (weight[n] > 0) sum.row(n) /= weight[n];
  }
  return sum;
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
