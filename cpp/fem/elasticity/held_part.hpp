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

// What a load case does to the nodes: forces from outside and of the stress (3 n, N), displacement
// (3 n, m); loaded: boundary triangles.
struct Response {
  std::vector<int> loaded;
  Eigen::VectorXd load, internal, displacement;
};

// What displacements say: forces, stress, peak, error; the fits of the recovery serve all of them.
// Throws ModelError if the exclusion leaves no place.
std::vector<StaticResult> read_results(const HeldPart& part,
                                       const std::vector<Response>& responses);

}  // namespace codesign::fem
