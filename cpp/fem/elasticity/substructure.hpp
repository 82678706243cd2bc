#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fem/boundary/supports.hpp"
#include "fem/elasticity/memory.hpp"
#include "fem/la/cholesky.hpp"
#include "fem/la/ordering.hpp"
#include "fem/mesh/material.hpp"
#include "fem/mesh/tet_mesh.hpp"

// A part in two pieces that meet in the nodes they share (static condensation): a design that
// reshapes some elements of a mesh keeps the factor of all others.
namespace codesign::fem {

// Some elements of a mesh, their inner nodes eliminated: what is left is a stiffness between the
// nodes that they share with others, its Schur complement.
class Substructure {
 public:
  // elements: flags of the mesh's tetrahedra. shared: nodes, ascending. Throws MemoryLimitError
  // where the factor is not within the limits.
  Substructure(const TetMesh& mesh, const std::vector<char>& elements, const Material& material,
               const Constraints& constraints, const std::vector<int>& shared,
               const FactorLimits& limits);

  // (k, k) N/m, of the free components of the shared nodes, in their order.
  const Eigen::MatrixXd& stiffness() const { return stiffness_; }

  double bytes() const;       // that it keeps
  double operations() const;  // that its factor took, multiply-adds

  // Forces on inner nodes, half eliminated, and what they do to the shared ones.
  struct Condensed {
    Eigen::VectorXd inner;   // of the factor's equations
    Eigen::VectorXd shared;  // (k) N
  };
  Condensed condense(const Eigen::VectorXd& load) const;  // (3 n) N, shared ones are ignored

  // Writes the displacements of the inner nodes, those of the shared ones being in u (3 n).
  void expand(Condensed condensed, Eigen::VectorXd& u) const;

 private:
  NodePattern pattern_;
  std::unique_ptr<CholeskyFactor> factor_;
  std::vector<int> equations_;  // (k) of the shared components, ascending
  std::vector<int> rank_;       // (k) their place among the shared components
  Eigen::MatrixXd corner_;      // (k, k) of the factor, at equations_
  Eigen::MatrixXd stiffness_;
};

// What does not change from design to design of one mesh.
struct KeptElements {
  std::vector<char> reshaped;   // (m) elements that do change
  NodePattern pattern;          // of them
  std::vector<int> components;  // free ones of the nodes between the two: 3 node + axis
  std::unique_ptr<const Substructure> rest;
};
std::shared_ptr<const KeptElements> keep_elements(const TetMesh& mesh, std::vector<char> reshaped,
                                                  const Material& material,
                                                  const Constraints& constraints,
                                                  const FactorLimits& limits);

// Factor of the reshaped elements on what has been kept of the others.
class CondensedFactor {
 public:
  // Throws SolverError if the part is not held, MeshError if an element is inverted.
  CondensedFactor(std::shared_ptr<const KeptElements> kept, const TetMesh& mesh,
                  const Material& material);

  Eigen::VectorXd solve(const Eigen::VectorXd& load) const;  // (3 n) N -> (3 n) m, 0 where held

 private:
  std::shared_ptr<const KeptElements> kept_;
  std::unique_ptr<CholeskyFactor> factor_;
};

}  // namespace codesign::fem
