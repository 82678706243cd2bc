#include "fem/boundary/remote_mass.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

#include "fem/mesh/material.hpp"

namespace codesign::fem {

namespace {

// Force and moment of a field acceleration + gradient (x - point) on a body: with r from its center
// of mass, the integral of r x (gradient r) over it is the axial vector of gradient S, S = integral
// of r rᵀ = tr(inertia) / 2 - inertia.
AffineTraction pulled(const RemoteMass& body, const Acceleration& field) {
  const Eigen::Matrix3d spread =
      0.5 * body.inertia.trace() * Eigen::Matrix3d::Identity() - body.inertia;
  const Eigen::Matrix3d product = field.gradient * spread;
  const Eigen::Vector3d moment(product(2, 1) - product(1, 2), product(0, 2) - product(2, 0),
                               product(1, 0) - product(0, 1));
  const Eigen::Vector3d force =
      body.mass * (field.acceleration + field.gradient * (body.position - field.point));
  return {body.where, force, body.position, moment, body.region, body.mirror};
}

// L with L Lᵀ = inertia.
Eigen::Matrix3d root(const Eigen::Matrix3d& inertia) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(inertia);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace

void check_masses(const std::vector<RemoteMass>& masses) {
  for (const RemoteMass& body : masses) {
    if (!(std::isfinite(body.mass) && body.mass > 0)) {
      throw std::invalid_argument("a remote mass must be > 0 kg");
    }
    const Eigen::Matrix3d& inertia = body.inertia;
    const double size = inertia.cwiseAbs().maxCoeff();
    if (!inertia.allFinite() || !body.position.allFinite() ||
        (inertia - inertia.transpose()).cwiseAbs().maxCoeff() > 1e-9 * size ||
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues()[0] < -1e-9 * size) {
      throw std::invalid_argument(
          "the inertia of a remote mass must be symmetric and not negative");
    }
  }
}

std::vector<Load> with_masses(const std::vector<Load>& loads,
                              const std::vector<RemoteMass>& masses) {
  std::vector<Load> all = loads;
  for (const Load& load : loads) {
    const auto* field = std::get_if<Acceleration>(&load);
    if (field == nullptr) continue;
    for (const RemoteMass& body : masses) all.emplace_back(pulled(body, *field));
  }
  return all;
}

Eigen::MatrixXd mass_columns(const TetMesh& mesh, const std::vector<RemoteMass>& masses) {
  Eigen::MatrixXd columns(3 * mesh.nodes.rows(), 6 * static_cast<Eigen::Index>(masses.size()));
  Eigen::Index column = 0;
  for (const RemoteMass& body : masses) {
    const Eigen::Matrix3d turning = root(body.inertia);
    for (int k = 0; k < 6; ++k) {
      const Eigen::Vector3d force =
          k < 3 ? Eigen::Vector3d(std::sqrt(body.mass) * Eigen::Vector3d::Unit(k))
                : Eigen::Vector3d(Eigen::Vector3d::Zero());
      const Eigen::Vector3d moment =
          k < 3 ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : Eigen::Vector3d(turning.col(k - 3));
      columns.col(column++) = load_vector(
          mesh, Material{},
          {AffineTraction{body.where, force, body.position, moment, body.region, body.mirror}});
    }
  }
  return columns;
}

}  // namespace codesign::fem
