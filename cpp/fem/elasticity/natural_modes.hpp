#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/boundary/remote_mass.hpp"
#include "fem/boundary/supports.hpp"
#include "fem/elasticity/memory.hpp"
#include "fem/elasticity/stiffness.hpp"
#include "fem/elasticity/two_level.hpp"
#include "fem/la/cholesky.hpp"
#include "fem/la/ordering.hpp"
#include "fem/mesh/material.hpp"
#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// Multiply-adds of a factorization that takes as long as eigenvalues by iteration.
inline constexpr double kEigenOperations = 1e11;

// What eigenvalues by a factor hold beside stiffness and factor: a second matrix, and about as many
// vectors as the block method takes for `count` of them. [bytes]
double eigen_bytes(const NodePattern& pattern, int count);

// Undamped free vibration, K x = (2 pi f)² M x.
struct NaturalModes {
  Eigen::VectorXd frequency;  // (k) Hz, ascending; 0 for rigid motions
  Eigen::MatrixXd shape;      // (3 n, k) column: x y z of node 0, then node 1 ...; modal mass 1 kg
};

// The lowest modes of a part on its supports (prescribed displacements count as held), or free:
// then the rigid motions come first. By a factor if it fits into the memory limit (bytes), else by
// iteration. Throws SolverError, MemoryLimitError, MeshError, ModelError: a free part with remote
// masses; std::invalid_argument if the material has no density or count < 1.
NaturalModes natural_modes(const TetMesh& mesh, const Material& material,
                           const std::vector<Support>& supports, int count,
                           double memory_limit = kMemoryLimit,
                           const std::vector<RemoteMass>& masses = {});

// (equations, 6 masses) the free rows of mass_columns; no column without masses.
Eigen::MatrixXd carried_columns(const TetMesh& mesh, const NodePattern& pattern,
                                const std::vector<RemoteMass>& masses);

// The same, carried carriedᵀ added to the mass matrix, from a factor of K + shift M, by the largest
// eigenvalues of (K + shift M)⁻¹ M.
NaturalModes modes_of_factor(const NodePattern& pattern, const LowerMatrix& mass,
                             const Eigen::MatrixXd& carried, const CholeskyFactor& factor,
                             double shift, int count);

// The same without a factor, from `stiffness`, K + shift M, and its preconditioner.
NaturalModes modes_by_iteration(const NodePattern& pattern, const LowerMatrix& nodal_mass,
                                const Eigen::MatrixXd& carried, const LowerMatrix& stiffness,
                                const TwoLevelPreconditioner& preconditioner, double shift,
                                int count);

}  // namespace codesign::fem
