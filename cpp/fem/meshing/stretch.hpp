#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// Makes a body longer or shorter along a direction: s is a point's distance from the origin along
// it. What lies at s <= from stays, what lies at s >= to moves as one, and between them the change
// is spread evenly but for its two ends, where it begins and ends gently.
struct Stretch {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();      // m
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  // unit
  double from = 0.0, to = 1.0;                           // m, the zone
  double change = 0.0;                                   // m, of its length
};

// Throws std::invalid_argument: no unit direction, an empty zone, or one that would lose more than
// two thirds of its length.
void check_stretch(const Stretch& stretch);

// The mesh of the stretched body, with the same elements. Corner nodes move; mid-edge nodes keep
// their distance from the middle of their edge, so that a prism's curved sides stay what they are.
// Throws MeshError if an element comes out flat or inverted.
TetMesh stretched(const TetMesh& mesh, const Stretch& stretch);

// (m) Whether an element gets another shape: all others stay or move as they are.
std::vector<char> reshaped_tets(const TetMesh& mesh, const Stretch& stretch);

}  // namespace codesign::fem
