#pragma once

#include <vector>

#include "fem/mesh/material.hpp"
#include "fem/mesh/tet_mesh.hpp"
#include "fem/stress/body_edges.hpp"
#include "fem/stress/stress.hpp"

namespace codesign::fem {

// Tips of the body and the stress (Pa) that their only element has there: no patch surrounds such a
// place, and what the element has is nearer than what a fit extrapolates (NAFEMS LE10 on free
// meshes, docs/fem.md).
struct CornerStress {
  std::vector<int> nodes;
  Stresses stress;
};
CornerStress corner_stress(const TetMesh& mesh, const std::vector<BodyPlace>& places,
                           const Material& material, const Eigen::VectorXd& displacement);

}  // namespace codesign::fem
