#include "fem/meshing/stretch.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "errors.hpp"
#include "fem/mesh/tet10.hpp"

namespace codesign::fem {
namespace {

constexpr double kGentle = 0.2;          // share of the zone over which the change begins, and ends
constexpr double kMostLost = 2.0 / 3.0;  // of the zone's length: elements would get too flat

double along(const Stretch& stretch, const Eigen::Vector3d& p) {
  return stretch.direction.dot(p - stretch.origin);
}

// Share of the change that a point in the zone moves by, at t = 0 ... 1 of it: its slope rises
// linearly, stays, and falls.
double share(double t) {
  constexpr double kSlope = 1.0 / (1.0 - kGentle);
  if (t <= 0.0) return 0.0;
  if (t >= 1.0) return 1.0;
  if (t < kGentle) return 0.5 * kSlope * t * t / kGentle;
  if (t > 1.0 - kGentle) return 1.0 - 0.5 * kSlope * (1.0 - t) * (1.0 - t) / kGentle;
  return kSlope * (t - 0.5 * kGentle);
}

Eigen::Vector3d moved(const Stretch& stretch, const Eigen::Vector3d& p) {
  const double t = (along(stretch, p) - stretch.from) / (stretch.to - stretch.from);
  return p + share(t) * stretch.change * stretch.direction;
}

void check_shapes(const TetMesh& mesh) {
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    const TetNodes x = tet_nodes(mesh, e);
    const Eigen::Vector3d a = x.col(1) - x.col(0), b = x.col(2) - x.col(0), c = x.col(3) - x.col(0);
    if (a.cross(b).dot(c) > 0.0) continue;
    throw MeshError("element " + std::to_string(e) +
                    " is flat or inverted after the mesh was stretched");
  }
}

}  // namespace

void check_stretch(const Stretch& stretch) {
  const bool finite = stretch.origin.allFinite() && std::isfinite(stretch.from) &&
                      std::isfinite(stretch.to) && std::isfinite(stretch.change);
  if (!finite || !(std::abs(stretch.direction.norm() - 1.0) < 1e-9))
    throw std::invalid_argument("stretch: finite numbers and a unit direction are needed");
  const double length = stretch.to - stretch.from;
  if (!(length > 0.0)) throw std::invalid_argument("stretch: the zone has no length");
  if (!(stretch.change >= -kMostLost * length))
    throw std::invalid_argument("stretch: the zone would lose more than two thirds of its length");
}

TetMesh stretched(const TetMesh& mesh, const Stretch& stretch) {
  check_stretch(stretch);
  TetMesh result = mesh;
  const auto node = [](const Points& nodes, int i) -> Eigen::Vector3d {
    return nodes.row(i).transpose();
  };
  for (int e = 0; e < mesh.tets.rows(); ++e)
    for (int i = 0; i < 4; ++i) {
      const int corner = mesh.tets(e, i);
      result.nodes.row(corner) = moved(stretch, node(mesh.nodes, corner)).transpose();
    }
  for (int e = 0; e < mesh.tets.rows(); ++e)
    for (int k = 0; k < 6; ++k) {
      const int a = mesh.tets(e, kTetEdges[k][0]), b = mesh.tets(e, kTetEdges[k][1]);
      const int mid = mesh.tets(e, 4 + k);
      const Eigen::Vector3d shift_a = node(result.nodes, a) - node(mesh.nodes, a);
      const Eigen::Vector3d shift_b = node(result.nodes, b) - node(mesh.nodes, b);
      result.nodes.row(mid) = (node(mesh.nodes, mid) + 0.5 * (shift_a + shift_b)).transpose();
    }
  check_shapes(result);
  return result;
}

std::vector<char> reshaped_tets(const TetMesh& mesh, const Stretch& stretch) {
  std::vector<char> reshaped(static_cast<std::size_t>(mesh.tets.rows()));
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    bool before = true, behind = true;
    for (int i = 0; i < 4; ++i) {
      const double s = along(stretch, mesh.nodes.row(mesh.tets(e, i)).transpose());
      before = before && s <= stretch.from;
      behind = behind && s >= stretch.to;
    }
    reshaped[static_cast<std::size_t>(e)] = !before && !behind;
  }
  return reshaped;
}

}  // namespace codesign::fem
