#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/mesh/tet_mesh.hpp"
#include "fem/stress/recovery.hpp"
#include "fem/stress/stress.hpp"

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

// Estimated error (Pa) of the peak stress, from an indicator x: the spread of the recovery there
// plus 0.4 times the largest root mean square difference between finite-element and recovered
// stress over the elements around the face, relative to the peak. Calibrated on the study's parts
// (docs/fem.md): sqrt(3 %² + (x / 2)²) + 23 x³. The first term is the noise of a largest of many
// values, the last one counts where elements are too coarse for x to be proportional to the error.
// An estimate, not a bound.
double peak_stress_error(const TetMesh& mesh, const PointStresses& points,
                         const RecoveryError& recovery, const PeakStress& peak);

}  // namespace codesign::fem
