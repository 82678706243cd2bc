#pragma once

#include <Eigen/Core>

#include "fem/la/lower_matrix.hpp"
#include "fem/la/ordering.hpp"
#include "fem/mesh/material.hpp"
#include "fem/mesh/tet_mesh.hpp"

// Matrices that act on the three components alike, kept by nodes: one entry for each pair of
// positions of a pattern, a ninth of the memory.
namespace codesign::fem {

// Consistent mass, kg.
LowerMatrix assemble_nodal_mass(const TetMesh& mesh, const Material& material,
                                const NodePattern& pattern);

// Geometric stiffness of a displacement (3 n, m), N/m.
LowerMatrix assemble_nodal_geometric_stiffness(const TetMesh& mesh, const Material& material,
                                               const Eigen::VectorXd& displacement,
                                               const NodePattern& pattern);

// A x for the equations of the pattern.
Eigen::VectorXd multiply_nodal(const NodePattern& pattern, const LowerMatrix& nodal,
                               const Eigen::VectorXd& x);

// matrix += factor * nodal, the matrix one of all equations of the pattern.
void add_nodal(double factor, const LowerMatrix& nodal, const NodePattern& pattern,
               LowerMatrix& matrix);

}  // namespace codesign::fem
