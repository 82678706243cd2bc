#pragma once

#include <Eigen/Core>
#include <optional>
#include <tuple>
#include <variant>
#include <vector>

#include "fem/boundary/selection.hpp"
#include "fem/mesh/material.hpp"
#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// A member of a kind of load as Python shall see it: its name there, its unit, where it is.
template <typename Owner, typename Value>
struct LoadMember {
  using Type = Value;
  const char* name;
  const char* unit;
  Value Owner::*place;
};

// A total force (N) spread uniformly over the area of the selected faces, or in equal parts over
// the nodes if the selection holds nodes only.
struct Force {
  Selection where;
  Eigen::Vector3d force;
  static constexpr const char* kName = "Force";
  static constexpr auto kMembers =
      std::tuple{LoadMember{"where", "", &Force::where}, LoadMember{"force", "N", &Force::force}};
};

// A force per area (Pa), the same vector everywhere.
struct Traction {
  Selection where;
  Eigen::Vector3d traction;
  static constexpr const char* kName = "Traction";
  static constexpr auto kMembers = std::tuple{LoadMember{"where", "", &Traction::where},
                                              LoadMember{"traction", "Pa", &Traction::traction}};
};

// Pushes against the outward normal (Pa).
struct Pressure {
  Selection where;
  double pressure = 0.0;
  static constexpr const char* kName = "Pressure";
  static constexpr auto kMembers = std::tuple{LoadMember{"where", "", &Pressure::where},
                                              LoadMember{"pressure", "Pa", &Pressure::pressure}};
};

// A total force (N) by pressure alone, as a pin presses on a bore: see bearing.hpp.
struct BearingLoad {
  Selection where;
  Eigen::Vector3d force;
  static constexpr const char* kName = "BearingLoad";
  static constexpr auto kMembers = std::tuple{LoadMember{"where", "", &BearingLoad::where},
                                              LoadMember{"force", "N", &BearingLoad::force}};
};

// Points within radius (m) of the line through center along axis.
struct Disc {
  Eigen::Vector3d center;
  Eigen::Vector3d axis;
  double radius = 0.0;
};

// Through point, a unit normal.
struct Plane {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
};

// The traction a + b x (x - x0) over the selected faces whose resultant is force (N) acting at
// point and moment (N m) about it, both exact; of all tractions with this resultant the one with
// the least mean square. A region limits it to the part of the faces inside a disc. With a mirror
// the faces are one half of the loaded ones, the other is their mirror image: the traction is that
// on both, and the resultant is of both.
struct AffineTraction {
  Selection where;
  Eigen::Vector3d force;
  Eigen::Vector3d point;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  std::optional<Disc> region;
  std::optional<Plane> mirror;
  static constexpr const char* kName = "AffineTraction";
  static constexpr auto kMembers = std::tuple{LoadMember{"where", "", &AffineTraction::where},
                                              LoadMember{"force", "N", &AffineTraction::force},
                                              LoadMember{"point", "m", &AffineTraction::point},
                                              LoadMember{"moment", "N m", &AffineTraction::moment},
                                              LoadMember{"region", "", &AffineTraction::region},
                                              LoadMember{"mirror", "", &AffineTraction::mirror}};
};

// Gravity-like field (m/s²), affine in the place x: acceleration + gradient (x - point). A body
// force density times that acts in every element. The inertia of a part that turns with the angular
// velocity w and acceleration e has the gradient -([e]x + [w]x [w]x).
struct Acceleration {
  Eigen::Vector3d acceleration;
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();  // 1/s²
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  static constexpr const char* kName = "Acceleration";
  static constexpr auto kMembers =
      std::tuple{LoadMember{"acceleration", "m/s²", &Acceleration::acceleration},
                 LoadMember{"gradient", "1/s²", &Acceleration::gradient},
                 LoadMember{"point", "m", &Acceleration::point}};
};

// Force per volume (N/m³): one row, or one row per node, interpolated by the shape functions.
struct BodyForce {
  Points force;
  static constexpr const char* kName = "BodyForce";
  static constexpr auto kMembers = std::tuple{LoadMember{"force", "N/m³", &BodyForce::force}};
};

// All kinds. Python has a class of every one, made of its kName and kMembers.
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
