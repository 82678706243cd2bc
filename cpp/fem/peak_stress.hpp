#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/stress.hpp"
#include "fem/tet_mesh.hpp"

namespace codesign::fem {

// Where the peak is not looked for: within distance (m) of the clamped triangles and of the border
// of the loaded ones, where the stress of a linear elastic model grows without end under
// refinement.
struct PeakExclusion {
  std::vector<int> clamped;
  std::vector<int> loaded;
  double distance = 0.0;
};

struct PeakStress {
  double value = 0.0;  // Pa
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  int triangle = -1;                                    // row of TetMesh::boundary
  Eigen::Vector2d reference = Eigen::Vector2d::Zero();  // where in it
};

// Largest von Mises stress of the nodal stress interpolated over the boundary faces, sampled at 66
// points a face. Throws std::invalid_argument if the exclusion leaves no point.
PeakStress peak_stress(const TetMesh& mesh, const Stresses& nodal, const PeakExclusion& exclusion);

}  // namespace codesign::fem
