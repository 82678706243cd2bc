#include "fem/mesh/mesh_quality.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fem/mesh/tet10.hpp"
#include "fem/mesh/tet_neighbors.hpp"
#include "fem/surface/connected_groups.hpp"

namespace codesign::fem {
namespace {

double signed_volume(const TetMesh& mesh, Eigen::Index t) {
  const Eigen::RowVector3d a = mesh.nodes.row(mesh.tets(t, 0));
  const Eigen::RowVector3d b = mesh.nodes.row(mesh.tets(t, 1)) - a;
  const Eigen::RowVector3d c = mesh.nodes.row(mesh.tets(t, 2)) - a;
  const Eigen::RowVector3d d = mesh.nodes.row(mesh.tets(t, 3)) - a;
  return b.dot(c.cross(d)) / 6.0;
}

}  // namespace

int count_pieces(const TetMesh& mesh) {
  return connected_groups(tet_neighbors(mesh.tets.leftCols<4>())).second;
}

Eigen::Matrix<double, 6, 1> dihedral_angles(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                            const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  const Eigen::Vector3d x[4] = {a, b, c, d};
  Eigen::Vector3d normal[4];  // outward, of the side opposite to each corner
  for (int k = 0; k < 4; ++k) {
    const auto& s = kTetSides[k];
    normal[k] = (x[s[1]] - x[s[0]]).cross(x[s[2]] - x[s[0]]);
  }
  Eigen::Matrix<double, 6, 1> angles;
  for (int e = 0; e < 6; ++e) {
    // The two sides at edge (i, j) are those opposite to the other two corners.
    const int i = kTetEdges[e][0], j = kTetEdges[e][1];
    int p = 0;
    while (p == i || p == j) ++p;
    const int q = 6 - i - j - p;
    const Eigen::Vector3d& n = normal[p];
    const Eigen::Vector3d& m = normal[q];
    angles[e] = std::atan2(n.cross(m).norm(), -n.dot(m));
  }
  return angles;
}

MeshQuality measure_quality(const TetMesh& mesh) {
  MeshQuality quality{};
  quality.min_dihedral = std::numeric_limits<double>::infinity();
  quality.min_radius_ratio = std::numeric_limits<double>::infinity();
  constexpr double kFiveDegrees = 5.0 * 3.14159265358979323846 / 180.0;
  for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
    const Eigen::Vector3d a = mesh.nodes.row(mesh.tets(t, 0)).transpose();
    const Eigen::Vector3d b = mesh.nodes.row(mesh.tets(t, 1)).transpose();
    const Eigen::Vector3d c = mesh.nodes.row(mesh.tets(t, 2)).transpose();
    const Eigen::Vector3d d = mesh.nodes.row(mesh.tets(t, 3)).transpose();
    const Eigen::Matrix<double, 6, 1> angles = dihedral_angles(a, b, c, d);
    if (angles.minCoeff() < quality.min_dihedral) {
      quality.min_dihedral = angles.minCoeff();
      quality.worst_tet = static_cast<int>(t);
    }
    quality.max_dihedral = std::max(quality.max_dihedral, angles.maxCoeff());
    quality.below_5_degrees += angles.minCoeff() < kFiveDegrees;

    const double volume = signed_volume(mesh, t);
    const double sides = 0.5 * ((b - a).cross(c - a).norm() + (b - a).cross(d - a).norm() +
                                (c - a).cross(d - a).norm() + (c - b).cross(d - b).norm());
    // Circumradius: sqrt(s (s-p)(s-q)(s-r)) / (6 V) with the products of opposite edges p, q, r.
    const double p = (b - a).norm() * (d - c).norm();
    const double q = (c - a).norm() * (d - b).norm();
    const double r = (d - a).norm() * (c - b).norm();
    const double s = 0.5 * (p + q + r);
    const double product = std::sqrt(std::max(0.0, s * (s - p) * (s - q) * (s - r)));
    const double ratio = sides > 0.0 && product > 0.0
                             ? 3.0 * (3.0 * volume / sides) * (6.0 * volume / product)
                             : 0.0;
    quality.min_radius_ratio = std::min(quality.min_radius_ratio, ratio);
    quality.mean_radius_ratio += ratio / static_cast<double>(mesh.tets.rows());
    quality.volume += volume;
  }
  for (Eigen::Index i = 0; i < mesh.boundary.rows(); ++i) {
    const Eigen::RowVector3d a = mesh.nodes.row(mesh.boundary(i, 0));
    const Eigen::RowVector3d u = mesh.nodes.row(mesh.boundary(i, 1)) - a;
    const Eigen::RowVector3d v = mesh.nodes.row(mesh.boundary(i, 2)) - a;
    quality.area += 0.5 * u.cross(v).norm();
  }
  return quality;
}

}  // namespace codesign::fem
