#include "fem/boundary/selection.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fem/boundary/smooth_patch.hpp"
#include "model_error.hpp"

namespace codesign::fem {

namespace {

int face_index(const TetMesh& mesh, const std::string& name) {
  const auto found = std::find(mesh.face_names.begin(), mesh.face_names.end(), name);
  if (found != mesh.face_names.end()) {
    return static_cast<int>(found - mesh.face_names.begin());
  }
  std::string known;
  for (const std::string& other : mesh.face_names) known += " '" + other + "'";
  throw ModelError("unknown face '" + name + "'; the mesh has" +
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
    throw ModelError(describe(selection) + " selects no boundary triangle");
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
  if (result.empty()) throw ModelError(describe(selection) + " selects no node");
  return result;
}

SurfaceMesh boundary_surface(const TetMesh& mesh) {
  return {mesh.nodes, mesh.boundary.leftCols<3>(), mesh.boundary_face, mesh.face_names};
}

std::vector<int> triangles_near(const TetMesh& mesh, const Eigen::Vector3d& point,
                                double max_bend) {
  const SurfaceMesh surface = boundary_surface(mesh);
  return smooth_patch(surface, nearest_triangle(surface, point), max_bend).triangles;
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
