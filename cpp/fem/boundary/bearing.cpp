#include "fem/boundary/bearing.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "fem/mesh/tet10.hpp"
#include "model_error.hpp"

namespace codesign::fem {

namespace {

constexpr double kFlat = 1e-3;       // of the largest spread of normals: none along the axis
constexpr double kMiss = 1e-9;       // of the force: residual of the resultant
constexpr double kAlongAxis = 1e-3;  // of the force: what may lie along the axis
constexpr int kMaxSteps = 60;

// Inward unit normal and area of each integration point.
struct Pressed {
  Eigen::Vector3d inward;
  double area;
};

std::vector<Pressed> pressed_points(const TetMesh& mesh, const std::vector<int>& triangles) {
  std::vector<Pressed> points;
  const TriangleRule& rule = triangle_rule_12();
  for (const int t : triangles) {
    const FaceNodes x = face_nodes(mesh, t);
    for (std::size_t q = 0; q < rule.points.size(); ++q) {
      const Eigen::Vector3d area = rule.weights[q] * evaluate_face(x, rule.points[q]).area;
      points.push_back({-area.normalized(), area.norm()});
    }
  }
  return points;
}

// The sum of pressure times inward area, and its derivative with respect to c.
void resultant(const std::vector<Pressed>& points, const Eigen::Vector3d& c, Eigen::Vector3d& force,
               Eigen::Matrix3d& slope) {
  force.setZero();
  slope.setZero();
  for (const Pressed& p : points) {
    const double pressure = p.inward.dot(c);
    if (pressure <= 0.0) continue;
    force += p.area * pressure * p.inward;
    slope += p.area * p.inward * p.inward.transpose();
  }
}

// Least-squares solution without the directions in which the normals do not spread.
Eigen::Vector3d solve_in_plane(const Eigen::Matrix3d& slope, const Eigen::Vector3d& force) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(slope);
  Eigen::Vector3d solution = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const double value = eigen.eigenvalues()[k];
    if (value < kFlat * eigen.eigenvalues()[2]) continue;
    const Eigen::Vector3d direction = eigen.eigenvectors().col(k);
    solution += direction * (direction.dot(force) / value);
  }
  return solution;
}

}  // namespace

Eigen::Vector3d bearing_pressure(const TetMesh& mesh, const std::vector<int>& triangles,
                                 const Eigen::Vector3d& force) {
  const std::vector<Pressed> points = pressed_points(mesh, triangles);
  Eigen::Vector3d c = force, got;
  Eigen::Matrix3d slope;
  for (int step = 0; step < kMaxSteps; ++step) {
    resultant(points, c, got, slope);
    if (!(slope.trace() > 0)) break;
    const Eigen::Vector3d change = solve_in_plane(slope, force - got);
    c += change;
    if (change.norm() <= kMiss * c.norm()) break;
  }
  resultant(points, c, got, slope);
  if ((force - got).norm() > kAlongAxis * force.norm()) {
    throw ModelError(
        "no pressure on the face has the resultant of the bearing load: it has a part along the "
        "axis of the bore, or pulls away from the face; give that part as a force of its own");
  }
  return c;
}

}  // namespace codesign::fem
