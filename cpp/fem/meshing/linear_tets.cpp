#include "fem/meshing/linear_tets.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "fem/mesh/mesh_quality.hpp"
#include "fem/mesh/tet10.hpp"
#include "fem/mesh/tet_topology.hpp"
#include "fem/surface/connected_groups.hpp"
#include "fem/surface/edge_key.hpp"

namespace codesign::fem {
namespace {

TetNeighbors neighbors_of(const LinearTets& mesh) {
  return tet_neighbors(Eigen::Map<const Tets4>(mesh.tets.data()->data(), std::ssize(mesh.tets), 4));
}

const Eigen::Vector3d& corner_of(const LinearTets& mesh, std::size_t t, std::size_t k) {
  return mesh.points[static_cast<std::size_t>(mesh.tets[t][k])];
}

// How many boundary sides meet at each edge of the boundary.
class BoundaryEdges {
 public:
  void add(const std::array<int, 4>& tet, std::size_t side, int count) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto a = static_cast<std::size_t>(kTetSides[side][i]);
      const auto b = static_cast<std::size_t>(kTetSides[side][(i + 1) % 3]);
      uses_[edge_key(tet[a], tet[b])] += count;
    }
  }
  bool contains(int a, int b) const {
    const auto at = uses_.find(edge_key(a, b));
    return at != uses_.end() && at->second > 0;
  }

 private:
  std::unordered_map<std::uint64_t, int> uses_;
};

// The two boundary sides of a tetrahedron that is to be peeled.
bool find_flat(const LinearTets& mesh, std::size_t t, double flat_angle, double straight_angle,
               const BoundaryEdges& edges, std::array<std::size_t, 2>& outside) {
  std::size_t found = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (mesh.side_label[t][k] < 0) continue;
    if (found == 2) return false;
    outside[found++] = k;
  }
  const auto [p, q] = outside;
  if (found != 2 || mesh.side_label[t][p] != mesh.side_label[t][q]) return false;
  const Eigen::Matrix<double, 6, 1> angles = dihedral_angles(
      corner_of(mesh, t, 0), corner_of(mesh, t, 1), corner_of(mesh, t, 2), corner_of(mesh, t, 3));
  if (angles.minCoeff() >= flat_angle) return false;
  for (int e = 0; e < 6; ++e) {
    // The sides opposite to p and q meet at the edge of the other two corners.
    const auto i = static_cast<std::size_t>(kTetEdges[e][0]);
    const auto j = static_cast<std::size_t>(kTetEdges[e][1]);
    if (i != p && i != q && j != p && j != q && angles[e] <= straight_angle) return false;
  }
  return !edges.contains(mesh.tets[t][p], mesh.tets[t][q]);
}

}  // namespace

void keep_only(LinearTets& mesh, const std::vector<bool>& keep) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!keep[t]) continue;
    mesh.tets[kept] = mesh.tets[t];
    mesh.side_label[kept++] = mesh.side_label[t];
  }
  mesh.tets.resize(kept);
  mesh.side_label.resize(kept);
}

int peel_flat_tets(LinearTets& mesh, double flat_angle, double straight_angle) {
  TetNeighbors neighbors = neighbors_of(mesh);
  BoundaryEdges edges;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t k = 0; k < 4; ++k)
      if (mesh.side_label[t][k] >= 0) edges.add(mesh.tets[t], k, 1);
  std::vector<bool> keep(mesh.tets.size(), true);
  int peeled = 0;
  std::array<std::size_t, 2> outside{};
  for (bool again = true; again;) {
    again = false;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      if (!keep[t] || !find_flat(mesh, t, flat_angle, straight_angle, edges, outside)) continue;
      keep[t] = false;
      again = true;
      ++peeled;
      const int label = mesh.side_label[t][outside[0]];
      for (std::size_t k = 0; k < 4; ++k) {
        const bool inner = k != outside[0] && k != outside[1];
        edges.add(mesh.tets[t], k, inner ? 1 : -1);
        if (!inner) continue;
        const auto next = static_cast<std::size_t>(neighbors[t][k]);
        const auto back = static_cast<std::size_t>(
            std::find(neighbors[next].begin(), neighbors[next].end(), static_cast<int>(t)) -
            neighbors[next].begin());
        neighbors[next][back] = -1;
        mesh.side_label[next][back] = label;
      }
    }
  }
  if (peeled > 0) keep_only(mesh, keep);
  return peeled;
}

int remove_crumbs(LinearTets& mesh, double fraction) {
  const auto [piece, pieces] = connected_groups(neighbors_of(mesh));
  if (pieces <= 1) return 0;
  std::vector<double> volume(static_cast<std::size_t>(pieces), 0.0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Eigen::Vector3d& a = corner_of(mesh, t, 0);
    const Eigen::Vector3d b = corner_of(mesh, t, 1) - a, c = corner_of(mesh, t, 2) - a;
    volume[static_cast<std::size_t>(piece[t])] += b.dot(c.cross(corner_of(mesh, t, 3) - a)) / 6.0;
  }
  const double limit = fraction * *std::max_element(volume.begin(), volume.end());
  std::vector<bool> keep(mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    keep[t] = volume[static_cast<std::size_t>(piece[t])] >= limit;
  const auto removed = static_cast<int>(std::count(keep.begin(), keep.end(), false));
  keep_only(mesh, keep);
  return removed;
}

TetMesh to_quadratic(const LinearTets& mesh, const std::vector<std::string>& face_names) {
  std::vector<int> fresh(mesh.points.size(), -1);
  int used = 0;
  Tets4 tets(std::ssize(mesh.tets), 4);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t k = 0; k < 4; ++k) {
      int& to = fresh[static_cast<std::size_t>(mesh.tets[t][k])];
      if (to < 0) to = used++;
      tets(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(k)) = to;
    }
  Points corners(used, 3);
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    if (fresh[i] >= 0) corners.row(fresh[i]) = mesh.points[i].transpose();
  TetMesh quadratic = make_tet_mesh(corners, tets);
  quadratic.face_names = face_names;
  std::size_t b = 0;  // the boundary is in the order of the tetrahedra and their sides
  for (const std::array<int, 4>& labels : mesh.side_label)
    for (const int label : labels)
      if (label >= 0) quadratic.boundary_face[b++] = label;
  return quadratic;
}

}  // namespace codesign::fem
