#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fem/boundary/supports.hpp"
#include "fem/elasticity/memory.hpp"
#include "fem/la/ordering.hpp"
#include "fem/la/single_factor.hpp"
#include "fem/mesh/material.hpp"
#include "fem/mesh/tet_mesh.hpp"

// A part in pieces that meet in the nodes they share (static condensation): a design that reshapes
// some elements of a mesh keeps the factors of all others. Factors are in single precision, so a
// solution is one to be refined.
namespace codesign::fem {

// Some elements of a mesh, their inner nodes eliminated: what is left is a stiffness between the
// nodes that they share with others, its Schur complement.
class Substructure {
 public:
  // piece: those elements, with all nodes of the mesh. shared: nodes. Throws MemoryLimitError where
  // the factor is not within the limits, SolverError where single precision does not resolve it.
  Substructure(const TetMesh& piece, const Material& material, const Constraints& constraints,
               const std::vector<int>& shared, const FactorLimits& limits);

  // (k, k) N/m, of the free components of the shared nodes, in their order; its lower triangle.
  const Eigen::MatrixXf& stiffness() const { return factor_.complement(); }

  double bytes() const;       // that it keeps
  double operations() const;  // that its factor took, multiply-adds

  // Forces, half eliminated: (equations, m) N, those on the shared components last.
  Eigen::MatrixXf condense(const Eigen::MatrixXd& loads) const;  // (3 n, m) N, without shared ones

  // Writes the displacements of the inner nodes, those of the shared ones being in u (3 n, m).
  void expand(Eigen::MatrixXf condensed, Eigen::MatrixXd& u) const;

 private:
  NodePattern pattern_;
  SingleFactor factor_;
};

// What does not change from design to design of one mesh.
struct KeptElements {
  struct Piece {
    Substructure elements;
    std::vector<int> components;  // (k) free ones of its shared nodes: 3 node + axis
  };

  std::vector<char> reshaped;  // (m) elements that do change
  NodePattern pattern;         // of them
  std::vector<Piece> pieces;   // of the others, no two of which share a node

  double bytes() const;       // of the pieces
  double operations() const;  // that their factors took, multiply-adds
};

// Throws as Substructure does.
std::shared_ptr<const KeptElements> keep_elements(const TetMesh& mesh, std::vector<char> reshaped,
                                                  const Material& material,
                                                  const Constraints& constraints,
                                                  const FactorLimits& limits);

// Factor of the reshaped elements on what has been kept of the others.
class CondensedFactor {
 public:
  // Throws SolverError if the part is not held, or nearly so; MeshError if an element is inverted.
  CondensedFactor(std::shared_ptr<const KeptElements> kept, const TetMesh& mesh,
                  const Material& material);

  // (3 n, k) N -> (3 n, k) m in about six digits, 0 where held
  Eigen::MatrixXd solve(const Eigen::MatrixXd& loads) const;

 private:
  std::shared_ptr<const KeptElements> kept_;
  SingleFactor factor_;
};

}  // namespace codesign::fem
