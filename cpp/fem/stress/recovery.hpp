#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/mesh/material.hpp"
#include "fem/mesh/tet_mesh.hpp"
#include "fem/stress/body_edges.hpp"
#include "fem/stress/stress.hpp"

namespace codesign::fem {

// Continuous stress at the nodes by superconvergent patch recovery: around each corner node a
// quadratic polynomial is fitted to the point stresses of the surrounding elements (at least ten,
// and more where these hardly determine it), near points weighing most; it is read at the corner
// and, averaged over the two ends, at the mid-edge nodes. With the ten terms p(r) = (1, x, y, z,
// x², …, zx) of the place r over the patch radius, from the corner: σ(r) = Aᵀ p(r), A minimizing
// Σ_i w_i |Aᵀ p(r_i) − σ_i|², w = (|r|² + 0.01)^(−3/2).
// At edges of the body (body_edges.hpp) A also has one body force over the whole patch, whatever it
// is, ∂ₖ(div σ) = 0: that replaces what a patch on one side does not see. Corners:
// corner_stress.hpp. Source: Zienkiewicz and Zhu 1992; the weights follow moving least squares;
// equilibrium as a condition on the fit as in Ródenas et al. 2007 (SPR-C), here for any load.
// Measured on notches and on a thick cylinder (docs/fem.md): third order where averaged element
// stresses have second.
Stresses recover_stress(const TetMesh& mesh, const std::vector<BodyPlace>& places,
                        const PointStresses& points);

// The same, to the last digit, of any number of fields side by side, six columns each: at the
// points of PointStresses, and recovered at the nodes.
using StressFields = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
StressFields recover_fields(const TetMesh& mesh, const std::vector<BodyPlace>& places,
                            const Eigen::Ref<const StressFields>& points);

// How much the von Mises stress (Pa) at a point of a boundary face depends on the recovery: the
// difference between a fit that trusts near points more and one that smooths more.
double recovery_spread(const TetMesh& mesh, const std::vector<BodyPlace>& places,
                       const PointStresses& points, int triangle, const Eigen::Vector2d& reference);

// The same at a point (m) inside an element, where the fits around its four corners are averaged.
double recovery_spread_inside(const TetMesh& mesh, const std::vector<BodyPlace>& places,
                              const PointStresses& points, int element,
                              const Eigen::Vector3d& position);

// How far the finite-element stress is from the recovered one.
struct RecoveryError {
  double relative_energy = 0.0;  // energy norm of the difference over that of the recovered field
  Eigen::VectorXd element;       // (m) root mean square over the element of the difference's von
                                 // Mises stress, Pa
};
RecoveryError recovery_error(const TetMesh& mesh, const Material& material,
                             const Eigen::VectorXd& displacement, const Stresses& recovered);

}  // namespace codesign::fem
