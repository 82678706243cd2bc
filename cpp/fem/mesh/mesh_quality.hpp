#pragma once

#include <Eigen/Core>

#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// Shape of the tetrahedra between their corner nodes.
struct MeshQuality {
  double min_dihedral, max_dihedral;  // rad, over all six angles of every tetrahedron
  double min_radius_ratio;            // 3 · inscribed / circumscribed radius: 1 regular, 0 flat
  double mean_radius_ratio;
  int worst_tet;        // the one of the smallest dihedral angle
  int below_5_degrees;  // tetrahedra with a dihedral angle below 5°
  double volume, area;  // m³, m²
};
MeshQuality measure_quality(const TetMesh& mesh);

// Number of separate pieces (connected through sides).
int count_pieces(const TetMesh& mesh);

// The six dihedral angles of a tetrahedron at the edges 01 12 02 03 13 23. [rad]
Eigen::Matrix<double, 6, 1> dihedral_angles(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                            const Eigen::Vector3d& c, const Eigen::Vector3d& d);

}  // namespace codesign::fem
