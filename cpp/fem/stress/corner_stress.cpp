#include "fem/stress/corner_stress.hpp"

#include <Eigen/LU>

#include "fem/mesh/incidence.hpp"
#include "fem/mesh/tet10.hpp"
#include "fem/stress/body_edges.hpp"

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

CornerStress corner_stress(const TetMesh& mesh, const Material& material,
                           const Eigen::VectorXd& displacement) {
  const double lambda = lame_lambda(material), mu = shear_modulus(material);
  const std::vector<BodyPlace> places = body_places(mesh);
  const Incidence incidence = elements_of_nodes(mesh, 4);
  CornerStress result;
  std::vector<int> elements;
  for (int n = 0; n < mesh.nodes.rows(); ++n) {
    const int first = incidence.start[at(n)];
    if (places[at(n)] != BodyPlace::corner || incidence.start[at(n) + 1] != first + 1) continue;
    result.nodes.push_back(n);
    elements.push_back(incidence.element[at(first)]);
  }
  result.stress.resize(static_cast<Eigen::Index>(elements.size()), 6);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    int corner = 0;
    while (mesh.tets(elements[i], corner) != result.nodes[i]) ++corner;
    const Eigen::Matrix3d h = gradient_at(mesh, elements[i], corner, displacement);
    result.stress.row(static_cast<Eigen::Index>(i)) = stress_of_gradient(lambda, mu, h).transpose();
  }
  return result;
}

}  // namespace codesign::fem
