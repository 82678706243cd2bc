#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/elasticity/element_matrices.hpp"
#include "fem/la/lower_matrix.hpp"
#include "fem/la/ordering.hpp"
#include "fem/mesh/material.hpp"
#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// Stiffness of the free components in elimination order. Throws MeshError if an element is
// inverted (non-positive Jacobian at an integration point).
LowerMatrix assemble_stiffness(const TetMesh& mesh, const Material& material,
                               const NodePattern& pattern);

// Consistent mass of the free components, kg, with the same structure.
LowerMatrix assemble_mass(const TetMesh& mesh, const Material& material,
                          const NodePattern& pattern);

// Geometric (initial-stress) stiffness of the free components, N/m, with the same structure:
// sigma the stress of a displacement field (3 n, m); see GeometricElement.
LowerMatrix assemble_geometric_stiffness(const TetMesh& mesh, const Material& material,
                                         const Eigen::VectorXd& displacement,
                                         const NodePattern& pattern);

// Stiffness, plus `shift` times the mass, seen by displacements that are linear over each element
// (exact also on curved ones): `pattern` numbers corner nodes only, mid-edge nodes follow the mean
// of their ends where they are free in `constraints`. Symmetric positive definite wherever the sum
// is.
LowerMatrix assemble_linear_stiffness(const TetMesh& mesh, const Material& material,
                                      const Constraints& constraints, const NodePattern& pattern,
                                      double shift = 0.0);

// Nodal forces with which the elements resist displacement fields, a column each: integral of
// Bᵀ sigma, from stresses instead of matrices.
struct InternalForces {
  Eigen::MatrixXd sum;   // (3 n, k) over the elements of a node
  Eigen::MatrixXd size;  // (3 n, k) sum of absolute values: what flows through the node
};
InternalForces internal_forces(const TetMesh& mesh, const Material& material,
                               const Eigen::MatrixXd& displacements);

}  // namespace codesign::fem
