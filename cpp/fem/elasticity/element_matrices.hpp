#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/mesh/material.hpp"
#include "fem/mesh/tet10.hpp"
#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

using ElementMatrix = Eigen::Matrix<double, 30, 30>;  // equation 3 * local node + component
// Of an element matrix that acts on each of the three components alike.
using NodeMatrix = Eigen::Matrix<double, kTetNodes, kTetNodes>;

// Stiffness of one element with full integration, N/m. Throws MeshError if it is inverted.
void element_stiffness(const TetNodes& x, double lambda, double mu, ElementMatrix& k);

// Stress (Pa) of a displacement field at a point of an element.
Eigen::Matrix3d stress_tensor(double lambda, double mu, const TetNodes& u, const TetGradients& g);

// Consistent mass of an element by nodes, kg.
class MassElement {
 public:
  MassElement(const TetMesh& mesh, const Material& material);
  void operator()(int e, NodeMatrix& m);

 private:
  const TetMesh& mesh_;
  double density_;
  std::vector<TetValues> values_;
  TetPoints points_;
};

// Geometric (initial-stress) stiffness of an element by nodes, N/m: integral of
// grad N_a · sigma · grad N_b, sigma the stress of a displacement field (3 n, m). 14 points: the
// integrand is of degree 3 on a straight element.
class GeometricElement {
 public:
  GeometricElement(const TetMesh& mesh, const Material& material, const Eigen::VectorXd& u);
  void operator()(int e, NodeMatrix& m);

 private:
  const TetMesh& mesh_;
  const Eigen::VectorXd& displacement_;
  double lambda_, mu_;
  TetPoints points_;
};

}  // namespace codesign::fem
