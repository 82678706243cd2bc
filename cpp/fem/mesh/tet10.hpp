#pragma once

#include <Eigen/Core>
#include <array>

#include "fem/mesh/quadrature.hpp"
#include "fem/mesh/tet_mesh.hpp"

// The quadratic tetrahedron and its six-node face, straight or curved (isoparametric).
// Reference coordinates (xi, eta, zeta) are the barycentric coordinates of corners 1, 2, 3.
// Node order: corners, then mid-edge nodes on 01 12 02 03 13 23 (face: on 01 12 20).
namespace codesign::fem {

constexpr int kTetNodes = 10;
constexpr int kMaxTetPoints = 14;
// Ends of the edge on which local node 4 + k sits.
constexpr int kTetEdges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};

using TetNodes = Eigen::Matrix<double, 3, kTetNodes>;      // column: a node's position, m
using TetValues = Eigen::Matrix<double, kTetNodes, 1>;     // shape functions at a point
using TetGradients = Eigen::Matrix<double, 3, kTetNodes>;  // column: a shape function's gradient

// Shape functions and their gradients at a reference point of the element.
TetValues tet10_values(const Eigen::Vector3d& xi);
TetGradients tet10_reference_gradients(const Eigen::Vector3d& xi);  // with respect to xi

using FaceNodes = Eigen::Matrix<double, 3, 6>;
// Shape functions and their gradients at a reference point of a face.
Eigen::Matrix<double, 6, 1> tri6_values(const Eigen::Vector2d& xi);
Eigen::Matrix<double, 2, 6> tri6_reference_gradients(const Eigen::Vector2d& xi);

// Positions of the nodes of an element [m].
TetNodes tet_nodes(const TetMesh& mesh, int tet);
// Those of a nodal field (3 n).
TetNodes tet_displacements(const TetMesh& mesh, int tet,
                           const Eigen::Ref<const Eigen::VectorXd>& displacement);
FaceNodes face_nodes(const TetMesh& mesh, int boundary_triangle);

// True if every mid-edge node is the midpoint of its edge up to rounding.
bool is_straight(const TetNodes& x);

// What integration over one element needs: at each point the gradients in space (1/m) and the
// weight (m³, determinant included; negative where the element is inverted).
struct TetPoints {
  int count = 0;
  std::array<TetGradients, kMaxTetPoints> gradients;
  std::array<double, kMaxTetPoints> weights;
};
void evaluate_tet(const TetNodes& x, const TetRule& rule, TetPoints& out);

// Full integration of the stiffness: 4 points are exact on a straight element, a curved one
// gets 14.
const TetRule& stiffness_rule(const TetNodes& x);

// Point of a boundary face with its area vector per unit of reference area (outward normal times
// surface Jacobian, m²).
struct FacePoint {
  Eigen::Vector3d position;
  Eigen::Vector3d area;
  Eigen::Matrix<double, 6, 1> values;
};
FacePoint evaluate_face(const FaceNodes& x, const Eigen::Vector2d& xi);

}  // namespace codesign::fem
