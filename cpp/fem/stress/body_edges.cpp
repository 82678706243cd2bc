#include "fem/stress/body_edges.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "fem/mesh/tet10.hpp"
#include "fem/surface/surface_features.hpp"

namespace codesign::fem {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Outward normal of a curved face in the middle of its side from corner k to the next.
Eigen::Vector3d normal_on_side(const TetMesh& mesh, int triangle, int k) {
  static const Eigen::Vector2d middles[3] = {{0.5, 0.0}, {0.5, 0.5}, {0.0, 0.5}};
  return evaluate_face(face_nodes(mesh, triangle), middles[k]).area.normalized();
}

int side_to(const std::array<int, 3>& neighbors, int other) {
  return static_cast<int>(std::find(neighbors.begin(), neighbors.end(), other) - neighbors.begin());
}

}  // namespace

std::vector<BodyPlace> body_places(const TetMesh& mesh) {
  const Neighbors neighbors = triangle_neighbors(mesh.boundary.leftCols<3>());
  std::vector<int> edges(at(static_cast<int>(mesh.nodes.rows())), 0);
  for (int t = 0; t < mesh.boundary.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int other = neighbors[at(t)][at(k)];
      if (other < t) continue;  // seen from there, or open
      const Eigen::Vector3d here = normal_on_side(mesh, t, k);
      const Eigen::Vector3d there = normal_on_side(mesh, other, side_to(neighbors[at(other)], t));
      if (here.dot(there) > std::cos(kBodyEdge)) continue;
      for (const int column : {k, (k + 1) % 3, 3 + k}) ++edges[at(mesh.boundary(t, column))];
    }
  }
  std::vector<int> uses(edges.size(), 0);  // as a corner of elements
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    for (int k = 0; k < 4; ++k) ++uses[at(mesh.tets(e, k))];
  }
  std::vector<BodyPlace> places(edges.size(), BodyPlace::smooth);
  for (std::size_t n = 0; n < edges.size(); ++n) {
    if (edges[n] > 0) places[n] = BodyPlace::edge;
    if (edges[n] > 2) places[n] = uses[n] == 1 ? BodyPlace::tip : BodyPlace::corner;
  }
  return places;
}

}  // namespace codesign::fem
