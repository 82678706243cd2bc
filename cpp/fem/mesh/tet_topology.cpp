#include "fem/mesh/tet_topology.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "errors.hpp"
#include "fem/mesh/tet10.hpp"
#include "fem/surface/edge_key.hpp"

namespace codesign::fem {

namespace {

// Local nodes of the sides, outward, corners then mid-edge nodes on 01 12 20.
constexpr int kSideNodes[4][6] = {
    {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}, {0, 1, 3, 4, 8, 7}, {0, 2, 1, 6, 5, 4}};

template <class Tets>
void check(const Points& nodes, const Tets& tets) {
  if (!nodes.allFinite()) throw MeshError("the mesh has nodes that are not finite");
  if (tets.rows() == 0) throw MeshError("the mesh has no elements");
  std::vector<bool> used(static_cast<std::size_t>(nodes.rows()), false);
  for (Eigen::Index e = 0; e < tets.rows(); ++e)
    for (Eigen::Index k = 0; k < tets.cols(); ++k) {
      const int node = tets(e, k);
      if (node < 0 || node >= nodes.rows())
        throw MeshError("an element refers to node " + std::to_string(node) +
                        ", but there are only " + std::to_string(nodes.rows()));
      used[static_cast<std::size_t>(node)] = true;
    }
  const auto unused = std::find(used.begin(), used.end(), false);
  if (unused != used.end())
    throw MeshError("node " + std::to_string(unused - used.begin()) + " belongs to no element");
}

// Swaps two corners, and the mid-edge nodes with them, where the volume is negative.
void orient(const Points& nodes, Tets10& tets) {
  for (int e = 0; e < tets.rows(); ++e) {
    const Eigen::Vector3d x0 = nodes.row(tets(e, 0));
    Eigen::Matrix3d edges;
    for (int i = 0; i < 3; ++i) edges.col(i) = nodes.row(tets(e, i + 1)).transpose() - x0;
    const double volume = edges.col(0).dot(edges.col(1).cross(edges.col(2)));
    const double length = edges.colwise().norm().maxCoeff();
    if (!(std::abs(volume) > 1e-12 * length * length * length)) {
      throw MeshError("element " + std::to_string(e) + " has no volume");
    }
    if (volume > 0) continue;
    std::swap(tets(e, 1), tets(e, 2));
    std::swap(tets(e, 4), tets(e, 6));
    std::swap(tets(e, 8), tets(e, 9));
  }
}

void check_mid_nodes(const TetMesh& mesh) {
  for (Eigen::Index e = 0; e < mesh.tets.rows(); ++e)
    for (int k = 0; k < 6; ++k) {
      const Eigen::RowVector3d a = mesh.nodes.row(mesh.tets(e, kTetEdges[k][0]));
      const Eigen::RowVector3d b = mesh.nodes.row(mesh.tets(e, kTetEdges[k][1]));
      const Eigen::RowVector3d middle = mesh.nodes.row(mesh.tets(e, 4 + k));
      if ((middle - 0.5 * (a + b)).norm() > 0.4 * (b - a).norm())
        throw MeshError("element " + std::to_string(e) + ": node " + std::to_string(4 + k) +
                        " is far from the middle of its edge; the order is 01 12 02 03 13 23");
    }
}

void find_boundary(TetMesh& mesh) {
  const TetNeighbors neighbors = tet_neighbors(mesh.tets.leftCols<4>());
  Eigen::Index count = 0;
  for (const std::array<int, 4>& sides : neighbors)
    count += std::count(sides.begin(), sides.end(), -1);
  mesh.boundary.resize(count, 6);
  Eigen::Index row = 0;
  for (std::size_t e = 0; e < neighbors.size(); ++e)
    for (std::size_t k = 0; k < 4; ++k) {
      if (neighbors[e][k] >= 0) continue;
      for (int i = 0; i < 6; ++i)
        mesh.boundary(row, i) = mesh.tets(static_cast<Eigen::Index>(e), kSideNodes[k][i]);
      ++row;
    }
  mesh.boundary_face.assign(static_cast<std::size_t>(count), 0);
  mesh.face_names = {""};
}

}  // namespace

TetMesh make_tet_mesh(const Points& nodes, const Tets4& tets) {
  check(nodes, tets);
  TetMesh mesh;
  mesh.tets.resize(tets.rows(), 10);
  mesh.tets.leftCols<4>() = tets;
  std::unordered_map<std::uint64_t, int> middle;
  middle.reserve(static_cast<std::size_t>(2 * tets.rows()));
  std::vector<std::pair<int, int>> ends;
  const int first = static_cast<int>(nodes.rows());
  for (Eigen::Index e = 0; e < tets.rows(); ++e) {
    for (int k = 0; k < 6; ++k) {
      const int a = tets(e, kTetEdges[k][0]), b = tets(e, kTetEdges[k][1]);
      const auto [place, is_new] =
          middle.try_emplace(edge_key(a, b), first + static_cast<int>(ends.size()));
      if (is_new) ends.emplace_back(a, b);
      mesh.tets(e, 4 + k) = place->second;
    }
  }
  mesh.nodes.resize(nodes.rows() + static_cast<Eigen::Index>(ends.size()), 3);
  mesh.nodes.topRows(nodes.rows()) = nodes;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    mesh.nodes.row(nodes.rows() + static_cast<Eigen::Index>(i)) =
        0.5 * (nodes.row(ends[i].first) + nodes.row(ends[i].second));
  }
  orient(mesh.nodes, mesh.tets);
  find_boundary(mesh);
  return mesh;
}

TetMesh make_tet_mesh(const Points& nodes, const Tets10& tets) {
  check(nodes, tets);
  TetMesh mesh;
  mesh.nodes = nodes;
  mesh.tets = tets;
  check_mid_nodes(mesh);
  orient(mesh.nodes, mesh.tets);
  find_boundary(mesh);
  return mesh;
}

void name_faces(TetMesh& mesh, const std::vector<NamedSides>& faces) {
  const auto key = [](const auto& row) {
    std::array<int, 3> corners{row[0], row[1], row[2]};
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  std::map<std::array<int, 3>, int> face_of;
  mesh.face_names = {""};
  for (const NamedSides& face : faces) {
    for (Eigen::Index i = 0; i < face.sides.rows(); ++i)
      if (!face_of.try_emplace(key(face.sides.row(i)), static_cast<int>(mesh.face_names.size()))
               .second)
        throw MeshError("a side of face '" + face.name + "' is mentioned twice");
    mesh.face_names.push_back(face.name);
  }
  std::size_t found = 0;
  for (Eigen::Index b = 0; b < mesh.boundary.rows(); ++b) {
    const auto at = face_of.find(key(mesh.boundary.row(b)));
    mesh.boundary_face[static_cast<std::size_t>(b)] = at == face_of.end() ? 0 : at->second;
    found += at != face_of.end();
  }
  if (found != face_of.size())
    throw MeshError(std::to_string(face_of.size() - found) +
                    " sides of the named faces are not on the boundary of the mesh");
}

}  // namespace codesign::fem
