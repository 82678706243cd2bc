#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/boundary/remote_mass.hpp"
#include "fem/boundary/supports.hpp"
#include "fem/elasticity/static_solver.hpp"
#include "fem/mesh/material.hpp"
#include "fem/mesh/tet_mesh.hpp"
#include "fem/stress/body_edges.hpp"
#include "fem/stress/exclusion.hpp"

namespace codesign::fem {

// A part on its supports: all that is needed to read a result from a displacement, without factor.
struct HeldPart {
  TetMesh mesh;
  Material material;
  std::vector<Support> supports;
  std::vector<RemoteMass> masses;
  StaticSettings settings;
  Constraints constraints;
  std::vector<int> clamped;       // boundary triangles
  std::vector<BodyPlace> places;  // of the nodes
};

// Where the peak stress is not read if these triangles are loaded.
ExclusionZone exclusion_zone(const HeldPart& part, const std::vector<int>& loaded);

// What a displacement u (3 n) says: forces, stress, peak, error. load and internal are the nodal
// forces (3 n, N) from outside and of the stress. Throws ModelError if the exclusion leaves no
// place.
StaticResult read_result(const HeldPart& part, const std::vector<int>& loaded,
                         const Eigen::VectorXd& load, const Eigen::VectorXd& internal,
                         const Eigen::VectorXd& u);

}  // namespace codesign::fem
