#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/mesh/material.hpp"
#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// Rows: stress xx yy zz xy yz zx, Pa.
using Stresses = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

// Stress at the four points of each element where the quadratic tetrahedron's is most accurate
// (rows 4 e ... 4 e + 3), and the volume (m³) each point stands for.
struct PointStresses {
  Stresses stress;
  Eigen::VectorXd volume;
};
PointStresses point_stresses(const TetMesh& mesh, const Material& material,
                             const Eigen::VectorXd& displacement);

// (n) von Mises stress of every row, Pa.
Eigen::VectorXd von_mises(const Stresses& stress);

// The von Mises stress exceeded in the given volume (m³); the smallest one if there is less
// material. Elements whose centroid is closer than distance (m) to the clamped triangles do not
// count.
double stress_of_volume(const TetMesh& mesh, const PointStresses& points,
                        const std::vector<int>& clamped, double distance, double volume);

}  // namespace codesign::fem
