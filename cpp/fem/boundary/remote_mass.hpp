#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fem/boundary/loads.hpp"
#include "fem/boundary/selection.hpp"
#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// A rigid body that is carried by faces of a part (an engine on its seat): it moves with their mean
// rigid motion and stiffens nothing. Its forces are spread as those of an AffineTraction.
struct RemoteMass {
  Selection where;
  double mass = 0.0;                                  // kg
  Eigen::Vector3d position;                           // m, center of mass
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // kg m², about the center of mass
  std::optional<Disc> region;                         // of the faces, as of an AffineTraction
  std::optional<Plane> mirror;                        // the same
};

// Throws std::invalid_argument: mass not positive, inertia not symmetric or negative.
void check_masses(const std::vector<RemoteMass>& masses);

// The loads, and what every acceleration among them does to the masses.
std::vector<Load> with_masses(const std::vector<Load>& loads,
                              const std::vector<RemoteMass>& masses);

// (3 n, 6 masses) C: the masses add C Cᵀ to the mass matrix of the part.
Eigen::MatrixXd mass_columns(const TetMesh& mesh, const std::vector<RemoteMass>& masses);

}  // namespace codesign::fem
