#include "fem/stress/corner_stress.hpp"

#include <Eigen/LU>

#include "fem/mesh/tet10.hpp"

namespace codesign::fem {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Of the displacement at a corner of an element.
Eigen::Matrix3d gradient_at(const TetMesh& mesh, int element, int corner,
                            const Eigen::VectorXd& displacement) {
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();
  if (corner > 0) reference[corner - 1] = 1.0;
  const TetGradients g = tet10_reference_gradients(reference);
  const Eigen::Matrix3d jacobian = g * tet_nodes(mesh, element).transpose();
  return tet_displacements(mesh, element, displacement) * (jacobian.inverse() * g).transpose();
}

}  // namespace

CornerStress corner_stress(const TetMesh& mesh, const std::vector<BodyPlace>& places,
                           const Material& material, const Eigen::VectorXd& displacement) {
  const double lambda = lame_lambda(material), mu = shear_modulus(material);
  CornerStress result;
  std::vector<Voigt> stress;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    for (int corner = 0; corner < 4; ++corner) {
      if (places[at(mesh.tets(e, corner))] != BodyPlace::tip) continue;
      result.nodes.push_back(mesh.tets(e, corner));
      stress.push_back(stress_of_gradient(lambda, mu, gradient_at(mesh, e, corner, displacement)));
    }
  }
  result.stress.resize(static_cast<Eigen::Index>(stress.size()), 6);
  for (std::size_t i = 0; i < stress.size(); ++i) {
    result.stress.row(static_cast<Eigen::Index>(i)) = stress[i].transpose();
  }
  return result;
}

}  // namespace codesign::fem
