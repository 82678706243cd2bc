#pragma once

#include <functional>
#include <map>
#include <vector>

#include "fem/boundary/selection.hpp"
#include "fem/mesh/tet_topology.hpp"

// The unit cube, nx x ny x nz cells split into six tetrahedra each, its nodes (mid-edge nodes too)
// moved by a map: straight, distorted or curved quadratic meshes for tests.
namespace codesign::fem {

using Map = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

inline TetMesh box_mesh(
    int nx, int ny, int nz, const Map& map = [](const Eigen::Vector3d& x) { return x; }) {
  constexpr int kKuhn[6][4] = {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7},
                               {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}};
  const auto index = [&](int i, int j, int k) { return (k * (ny + 1) + j) * (nx + 1) + i; };
  Points nodes((nx + 1) * (ny + 1) * (nz + 1), 3);
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i)
        nodes.row(index(i, j, k)) << i / double(nx), j / double(ny), k / double(nz);
  Tets4 tets(6 * nx * ny * nz, 4);
  Eigen::Index e = 0;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        for (const auto& tet : kKuhn) {
          for (int c = 0; c < 4; ++c) {
            tets(e, c) = index(i + (tet[c] & 1), j + ((tet[c] >> 1) & 1), k + (tet[c] >> 2));
          }
          ++e;
        }
  TetMesh mesh = make_tet_mesh(nodes, tets);
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) {
    mesh.nodes.row(n) = map(mesh.nodes.row(n).transpose()).transpose();
  }
  return make_tet_mesh(mesh.nodes, mesh.tets);
}

inline std::vector<int> boundary_nodes(const TetMesh& mesh) {
  std::vector<int> all(static_cast<std::size_t>(mesh.boundary.rows()));
  for (std::size_t t = 0; t < all.size(); ++t) all[t] = static_cast<int>(t);
  return selected_nodes(mesh, Selection{{}, all, {}});
}

}  // namespace codesign::fem
