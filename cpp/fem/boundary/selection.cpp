#include "fem/boundary/selection.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "fem/surface/distance.hpp"

namespace codesign::fem {

namespace {

int face_index(const TetMesh& mesh, const std::string& name) {
  const auto found = std::find(mesh.face_names.begin(), mesh.face_names.end(), name);
  if (found != mesh.face_names.end()) {
    return static_cast<int>(found - mesh.face_names.begin());
  }
  std::string known;
  for (const std::string& other : mesh.face_names) known += " '" + other + "'";
  throw std::invalid_argument("unknown face '" + name + "'; the mesh has" +
                              (known.empty() ? " no named face" : known));
}

void check_index(int index, Eigen::Index size, const char* what) {
  if (index >= 0 && index < size) return;
  throw std::invalid_argument(std::string(what) + " " + std::to_string(index) + " is outside 0.." +
                              std::to_string(size - 1));
}

void sort_unique(std::vector<int>& v) {
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
}

std::vector<int> triangles_or_empty(const TetMesh& mesh, const Selection& selection) {
  std::vector<int> result = selection.triangles;
  for (const int t : result) check_index(t, mesh.boundary.rows(), "boundary triangle");
  for (const std::string& name : selection.faces) {
    const int face = face_index(mesh, name);
    for (int t = 0; t < mesh.boundary.rows(); ++t) {
      if (mesh.boundary_face[static_cast<std::size_t>(t)] == face) result.push_back(t);
    }
  }
  sort_unique(result);
  return result;
}

std::string describe(const Selection& selection) {
  return selection.faces.empty() ? "selection" : "face '" + selection.faces.front() + "'";
}

Eigen::Vector3d corner(const TetMesh& mesh, int triangle, int k) {
  return mesh.nodes.row(mesh.boundary(triangle, k)).transpose();
}

Eigen::Vector3d flat_normal(const TetMesh& mesh, int triangle) {
  const Eigen::Vector3d a = corner(mesh, triangle, 0);
  return (corner(mesh, triangle, 1) - a).cross(corner(mesh, triangle, 2) - a).normalized();
}

}  // namespace

std::vector<int> selected_triangles(const TetMesh& mesh, const Selection& selection) {
  std::vector<int> result = triangles_or_empty(mesh, selection);
  if (result.empty()) {
    throw std::invalid_argument(describe(selection) + " selects no boundary triangle");
  }
  return result;
}

std::vector<int> selected_nodes(const TetMesh& mesh, const Selection& selection) {
  std::vector<int> result = selection.nodes;
  for (const int n : result) check_index(n, mesh.nodes.rows(), "node");
  for (const int t : triangles_or_empty(mesh, selection)) {
    for (int k = 0; k < 6; ++k) result.push_back(mesh.boundary(t, k));
  }
  sort_unique(result);
  if (result.empty()) throw std::invalid_argument(describe(selection) + " selects no node");
  return result;
}

std::vector<int> triangles_near(const TetMesh& mesh, const Eigen::Vector3d& point,
                                double max_bend) {
  const int count = static_cast<int>(mesh.boundary.rows());
  if (count == 0) throw std::invalid_argument("the mesh has no boundary triangles");
  int nearest = 0;
  double best = std::numeric_limits<double>::infinity();
  std::map<std::pair<int, int>, std::vector<int>> edge_triangles;
  for (int t = 0; t < count; ++t) {
    const double d = squared_distance_to_triangle(point, corner(mesh, t, 0), corner(mesh, t, 1),
                                                  corner(mesh, t, 2));
    if (d < best) {
      best = d;
      nearest = t;
    }
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.boundary(t, k), b = mesh.boundary(t, (k + 1) % 3);
      edge_triangles[std::minmax(a, b)].push_back(t);
    }
  }
  const double min_cosine = std::cos(max_bend);
  std::vector<char> reached(static_cast<std::size_t>(count), 0);
  std::vector<int> queue{nearest};
  reached[static_cast<std::size_t>(nearest)] = 1;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const int t = queue[i];
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.boundary(t, k), b = mesh.boundary(t, (k + 1) % 3);
      for (const int other : edge_triangles[std::minmax(a, b)]) {
        const std::size_t o = static_cast<std::size_t>(other);
        if (reached[o] || mesh.boundary_face[o] != mesh.boundary_face[static_cast<std::size_t>(t)])
          continue;
        if (flat_normal(mesh, t).dot(flat_normal(mesh, other)) < min_cosine) continue;
        reached[o] = 1;
        queue.push_back(other);
      }
    }
  }
  std::sort(queue.begin(), queue.end());
  return queue;
}

std::vector<int> triangles_in_box(const TetMesh& mesh, const Eigen::Vector3d& lower,
                                  const Eigen::Vector3d& upper) {
  std::vector<int> result;
  for (int t = 0; t < mesh.boundary.rows(); ++t) {
    bool inside = true;
    for (int k = 0; k < 6 && inside; ++k) {
      const Eigen::Vector3d x = corner(mesh, t, k);
      inside = (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
    }
    if (inside) result.push_back(t);
  }
  return result;
}

std::vector<int> triangles_with_normal(const TetMesh& mesh, const Eigen::Vector3d& normal,
                                       double angle) {
  if (!(normal.norm() > 0)) throw std::invalid_argument("normal must not be zero");
  const Eigen::Vector3d direction = normal.normalized();
  const double min_cosine = std::cos(angle);
  std::vector<int> result;
  for (int t = 0; t < mesh.boundary.rows(); ++t) {
    if (flat_normal(mesh, t).dot(direction) >= min_cosine) result.push_back(t);
  }
  return result;
}

}  // namespace codesign::fem
