#include "fem/elasticity/element_matrices.hpp"

#include "errors.hpp"
#include "fem/mesh/quadrature.hpp"

namespace codesign::fem {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

void element_stiffness(const TetNodes& x, double lambda, double mu, ElementMatrix& k) {
  TetPoints points;
  evaluate_tet(x, stiffness_rule(x), points);
  // Integral of grad_a N_i grad_b N_j, from which isotropic elasticity is a recombination.
  ElementMatrix g = ElementMatrix::Zero();
  for (int q = 0; q < points.count; ++q) {
    const double weight = points.weights[at(q)];
    if (!(weight > 0)) throw MeshError("inverted element: its Jacobian is not positive");
    const Eigen::Map<const Eigen::Matrix<double, 30, 1>> v(points.gradients[at(q)].data());
    g.noalias() += (weight * v) * v.transpose();
  }
  for (int j = 0; j < kTetNodes; ++j) {
    for (int i = 0; i < kTetNodes; ++i) {
      const Eigen::Matrix3d gij = g.block<3, 3>(3 * i, 3 * j);
      k.block<3, 3>(3 * i, 3 * j) = lambda * gij + mu * gij.transpose();
      k.block<3, 3>(3 * i, 3 * j).diagonal().array() += mu * gij.trace();
    }
  }
}

Eigen::Matrix3d stress_tensor(double lambda, double mu, const TetNodes& u, const TetGradients& g) {
  const Eigen::Matrix3d h = u * g.transpose();  // d u_i / d x_j
  Eigen::Matrix3d stress = mu * (h + h.transpose());
  stress.diagonal().array() += lambda * h.trace();
  return stress;
}

MassElement::MassElement(const TetMesh& mesh, const Material& material)
    : mesh_(mesh), density_(material.density) {
  for (const Eigen::Vector3d& p : tet_rule_14().points) values_.push_back(tet10_values(p));
}

void MassElement::operator()(int e, NodeMatrix& m) {
  evaluate_tet(tet_nodes(mesh_, e), tet_rule_14(), points_);
  m.setZero();
  for (int q = 0; q < points_.count; ++q) {
    m.noalias() +=
        (density_ * points_.weights[at(q)] * values_[at(q)]) * values_[at(q)].transpose();
  }
}

GeometricElement::GeometricElement(const TetMesh& mesh, const Material& material,
                                   const Eigen::VectorXd& u)
    : mesh_(mesh), displacement_(u), lambda_(lame_lambda(material)), mu_(shear_modulus(material)) {}

void GeometricElement::operator()(int e, NodeMatrix& m) {
  const TetNodes u = tet_displacements(mesh_, e, displacement_);
  evaluate_tet(tet_nodes(mesh_, e), tet_rule_14(), points_);
  m.setZero();
  for (int q = 0; q < points_.count; ++q) {
    const TetGradients& g = points_.gradients[at(q)];
    m.noalias() += points_.weights[at(q)] * (g.transpose() * stress_tensor(lambda_, mu_, u, g) * g);
  }
}

}  // namespace codesign::fem
