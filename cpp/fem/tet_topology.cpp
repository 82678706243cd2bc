#include "fem/tet_topology.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "errors.hpp"
#include "fem/tet10.hpp"

namespace codesign::fem {

namespace {

// Local nodes of the faces, outward, corners then mid-edge nodes on 01 12 20.
constexpr int kFaces[4][6] = {
    {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}, {0, 1, 3, 4, 8, 7}, {0, 2, 1, 6, 5, 4}};

void check(const Points& nodes, const int* index, Eigen::Index count) {
  if (!nodes.allFinite()) throw MeshError("the mesh has nodes that are not finite");
  if (count == 0) throw MeshError("the mesh has no elements");
  const auto [low, high] = std::minmax_element(index, index + count);
  if (*low < 0 || *high >= nodes.rows()) {
    throw MeshError("an element refers to node " + std::to_string(*low < 0 ? *low : *high) +
                    ", but there are only " + std::to_string(nodes.rows()));
  }
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

void find_boundary(TetMesh& mesh) {
  std::vector<std::array<int, 5>> faces;  // sorted corners, element, local face
  faces.reserve(4 * static_cast<std::size_t>(mesh.tets.rows()));
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    for (int f = 0; f < 4; ++f) {
      std::array<int, 5> face{mesh.tets(e, kFaces[f][0]), mesh.tets(e, kFaces[f][1]),
                              mesh.tets(e, kFaces[f][2]), e, f};
      std::sort(face.begin(), face.begin() + 3);
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end());
  const auto same = [&](std::size_t i, std::size_t j) {
    return std::equal(faces[i].begin(), faces[i].begin() + 3, faces[j].begin());
  };
  std::vector<std::pair<int, int>> outside;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t j = i + 1;
    while (j < faces.size() && same(i, j)) ++j;
    if (j - i > 2) {
      throw MeshError("the face of nodes " + std::to_string(faces[i][0]) + " " +
                      std::to_string(faces[i][1]) + " " + std::to_string(faces[i][2]) +
                      " belongs to " + std::to_string(j - i) + " elements");
    }
    if (j - i == 1) outside.emplace_back(faces[i][3], faces[i][4]);
    i = j;
  }
  std::sort(outside.begin(), outside.end());
  mesh.boundary.resize(static_cast<Eigen::Index>(outside.size()), 6);
  for (std::size_t b = 0; b < outside.size(); ++b) {
    const auto [e, f] = outside[b];
    for (int k = 0; k < 6; ++k) {
      mesh.boundary(static_cast<Eigen::Index>(b), k) = mesh.tets(e, kFaces[f][k]);
    }
  }
  mesh.boundary_face.assign(outside.size(), 0);
  mesh.face_names = {""};
}

}  // namespace

TetMesh make_tet_mesh(const Points& nodes, const Tets4& tets) {
  check(nodes, tets.data(), tets.size());
  Tets10 quadratic(tets.rows(), 10);
  quadratic.leftCols<4>() = tets;
  std::map<std::pair<int, int>, int> middle;
  std::vector<Eigen::RowVector3d> added;
  const int first = static_cast<int>(nodes.rows());
  for (int e = 0; e < tets.rows(); ++e) {
    for (int k = 0; k < 6; ++k) {
      const int a = tets(e, kTetEdges[k][0]), b = tets(e, kTetEdges[k][1]);
      const auto [place, is_new] =
          middle.try_emplace(std::minmax(a, b), first + static_cast<int>(added.size()));
      if (is_new) added.push_back(0.5 * (nodes.row(a) + nodes.row(b)));
      quadratic(e, 4 + k) = place->second;
    }
  }
  Points all(nodes.rows() + static_cast<Eigen::Index>(added.size()), 3);
  all.topRows(nodes.rows()) = nodes;
  for (std::size_t i = 0; i < added.size(); ++i) {
    all.row(nodes.rows() + static_cast<Eigen::Index>(i)) = added[i];
  }
  return make_tet_mesh(all, quadratic);
}

TetMesh make_tet_mesh(const Points& nodes, const Tets10& tets) {
  check(nodes, tets.data(), tets.size());
  TetMesh mesh;
  mesh.nodes = nodes;
  mesh.tets = tets;
  orient(mesh.nodes, mesh.tets);
  find_boundary(mesh);
  return mesh;
}

}  // namespace codesign::fem
