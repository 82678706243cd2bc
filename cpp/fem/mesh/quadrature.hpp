#pragma once

#include <Eigen/Core>
#include <vector>

namespace codesign::fem {

// Points in reference coordinates; the weights sum to 1/6 (tetrahedron) or 1/2 (triangle).
struct TetRule {
  std::vector<Eigen::Vector3d> points;
  std::vector<double> weights;
};
struct TriangleRule {
  std::vector<Eigen::Vector2d> points;
  std::vector<double> weights;
};

// Exact for polynomials of degree 2 with 4 points: the stiffness of a straight-sided quadratic
// tetrahedron, and its best stress points.
const TetRule& tet_rule_4();

// Exact for degree 5 with 14 points (Walkington): curved elements, mass, body forces.
const TetRule& tet_rule_14();

// Exact for degree 6 with 12 points (Dunavant): loads on curved six-node faces.
const TriangleRule& triangle_rule_12();

// Centroids of the n² equal triangles of a subdivided reference triangle: for integrands that are
// cut off inside a face.
TriangleRule subdivided_triangle_rule(int n);

}  // namespace codesign::fem
