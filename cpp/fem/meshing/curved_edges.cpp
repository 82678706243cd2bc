#include "fem/meshing/curved_edges.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

#include "fem/mesh/tet10.hpp"
#include "fem/mesh/tet_neighbors.hpp"
#include "fem/meshing/feature_curve.hpp"
#include "fem/surface/edge_key.hpp"

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

constexpr double kSmallestJacobian = 0.1;  // of the straight element's
constexpr double kFlat = 2e-3;     // deviations below this part of the edge are not worth a curve
constexpr int kHalvings = 3;       // of a move, before the node goes back to the middle
constexpr double kFarthest = 0.3;  // a target farther than this part of the edge is a mistake

// An edge of the boundary: its mid node and the patches of the two triangles beside it.
struct BoundaryEdge {
  int a, b, middle;
  int first_patch, second_patch;
};

// A mid-edge node that left the middle of its edge.
struct MovedNode {
  Vector3d middle;
  int halvings;  // of its move
};

std::vector<BoundaryEdge> boundary_edges(const TetMesh& mesh, const std::vector<int>& patch) {
  std::vector<BoundaryEdge> edges;
  std::unordered_map<std::uint64_t, std::size_t> known;
  for (Eigen::Index t = 0; t < mesh.boundary.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.boundary(t, k), b = mesh.boundary(t, (k + 1) % 3);
      const int p = patch[static_cast<std::size_t>(t)];
      const auto [at, fresh] = known.try_emplace(edge_key(a, b), edges.size());
      if (fresh)
        edges.push_back({a, b, mesh.boundary(t, 3 + k), p, p});
      else
        edges[at->second].second_patch = p;
    }
  return edges;
}

using CurvesBetween = std::map<std::pair<int, int>, std::vector<FeatureCurve>>;

CurvesBetween curves_between(const SurfaceMesh& surface, const std::vector<FeatureLine>& lines) {
  CurvesBetween curves;
  for (const FeatureLine& line : lines) {
    std::vector<Vector3d> points;
    for (const int i : line.points) points.push_back(surface.points.row(i).transpose());
    curves[line.patches].emplace_back(std::move(points));
  }
  return curves;
}

Vector3d target_of(const BoundaryEdge& edge, const Vector3d& middle, const CurvesBetween& curves,
                   const SolidOracle& oracle) {
  const std::pair<int, int> patches = std::minmax(edge.first_patch, edge.second_patch);
  if (patches.first == patches.second) return oracle.nearest(middle, patches.first).point;
  const auto between = curves.find(patches);
  if (between == curves.end()) return middle;
  Vector3d best = middle;
  double distance = std::numeric_limits<double>::infinity();
  for (const FeatureCurve& curve : between->second) {
    const Vector3d point = curve.nearest(middle);
    if ((point - middle).squaredNorm() < distance) {
      distance = (point - middle).squaredNorm();
      best = point;
    }
  }
  return best;
}

// Smallest Jacobian determinant at the nodes and the center, relative to the straight element's.
double smallest_jacobian(const TetMesh& mesh, int t) {
  static const std::vector<TetGradients> gradients = [] {
    std::vector<Vector3d> places{Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY(),
                                 Vector3d::UnitZ()};
    for (const auto& edge : kTetEdges)
      places.push_back(0.5 * (places[static_cast<std::size_t>(edge[0])] +
                              places[static_cast<std::size_t>(edge[1])]));
    places.push_back(Vector3d::Constant(0.25));
    std::vector<TetGradients> at;
    for (const Vector3d& place : places) at.push_back(tet10_reference_gradients(place));
    return at;
  }();
  const TetNodes x = tet_nodes(mesh, t);
  const Vector3d a = x.col(0);
  const double straight = (x.col(1) - a).cross(x.col(2) - a).dot(x.col(3) - a);
  double smallest = std::numeric_limits<double>::infinity();
  for (const TetGradients& gradient : gradients) {
    const Eigen::Matrix3d jacobian = x * gradient.transpose();
    smallest = std::min(smallest, jacobian.determinant() / straight);
  }
  return smallest;
}

}  // namespace

int curve_edges(TetMesh& mesh, const std::vector<int>& patch, const SurfaceMesh& surface,
                const std::vector<FeatureLine>& lines, const SolidOracle& oracle,
                MeshWatch& watch) {
  const CurvesBetween curves = curves_between(surface, lines);
  std::unordered_map<int, MovedNode> moved;
  for (const BoundaryEdge& edge : boundary_edges(mesh, patch)) {
    watch.step("curving edges");
    const Vector3d middle = mesh.nodes.row(edge.middle).transpose();
    const double length = (mesh.nodes.row(edge.b) - mesh.nodes.row(edge.a)).norm();
    const Vector3d target = target_of(edge, middle, curves, oracle);
    const double distance = (target - middle).norm();
    if (distance < kFlat * length || distance > kFarthest * length) continue;
    mesh.nodes.row(edge.middle) = target.transpose();
    moved.emplace(edge.middle, MovedNode{middle, 0});
  }
  std::vector<int> curved;  // elements with a moved node
  for (int t = 0; t < static_cast<int>(mesh.tets.rows()); ++t)
    for (int k = 4; k < 10; ++k)
      if (moved.contains(mesh.tets(t, k))) {
        curved.push_back(t);
        break;
      }
  for (bool again = true; again;) {
    again = false;
    for (const int t : curved) {
      watch.step("curving edges");
      if (smallest_jacobian(mesh, t) >= kSmallestJacobian) continue;
      for (int k = 4; k < 10; ++k) {
        const auto node = moved.find(mesh.tets(t, k));
        if (node == moved.end()) continue;
        const Eigen::RowVector3d middle = node->second.middle.transpose();
        const bool back = ++node->second.halvings > kHalvings;
        mesh.nodes.row(node->first) += (back ? 1.0 : 0.5) * (middle - mesh.nodes.row(node->first));
        if (back) moved.erase(node);
        again = true;
      }
    }
  }
  return static_cast<int>(moved.size());
}

}  // namespace codesign::fem
