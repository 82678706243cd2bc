#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>
#include <vector>

#include "fem/boundary/selection.hpp"
#include "fem/mesh/material.hpp"
#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// A total force (N) spread uniformly over the area of the selected faces, or in equal parts over
// the nodes if the selection holds nodes only.
struct Force {
  Selection where;
  Eigen::Vector3d force;
};

// A force per area (Pa), the same vector everywhere.
struct Traction {
  Selection where;
  Eigen::Vector3d traction;
};

// Pushes against the outward normal (Pa).
struct Pressure {
  Selection where;
  double pressure = 0.0;
};

// A total force (N) by pressure alone, as a pin presses on a bore: see bearing.hpp.
struct BearingLoad {
  Selection where;
  Eigen::Vector3d force;
};

// Points within radius (m) of the line through center along axis.
struct Disc {
  Eigen::Vector3d center;
  Eigen::Vector3d axis;
  double radius = 0.0;
};

// The traction a + b x (x - x0) over the selected faces whose resultant is force (N) acting at
// point and moment (N m) about it, both exact; of all tractions with this resultant the one with
// the least mean square. A region limits it to the part of the faces inside a disc.
struct AffineTraction {
  Selection where;
  Eigen::Vector3d force;
  Eigen::Vector3d point;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  std::optional<Disc> region;
};

// Gravity-like field (m/s²), affine in the place x: acceleration + gradient (x - point). A body
// force density times that acts in every element. The inertia of a part that turns with the angular
// velocity w and acceleration e has the gradient -([e]x + [w]x [w]x).
struct Acceleration {
  Eigen::Vector3d acceleration;
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();  // 1/s²
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};

// Force per volume (N/m³): one row, or one row per node, interpolated by the shape functions.
struct BodyForce {
  Points force;
};

using Load =
    std::variant<Force, Traction, Pressure, BearingLoad, AffineTraction, Acceleration, BodyForce>;

// Consistent nodal forces (N), x y z of node 0, then node 1 ... Surface loads are integrated over
// the true, curved face.
Eigen::VectorXd load_vector(const TetMesh& mesh, const Material& material,
                            const std::vector<Load>& loads);

// Boundary triangles that carry a load, sorted.
std::vector<int> loaded_triangles(const TetMesh& mesh, const std::vector<Load>& loads);

// Area of the selected curved faces (m²).
double face_area(const TetMesh& mesh, const std::vector<int>& triangles);

}  // namespace codesign::fem
