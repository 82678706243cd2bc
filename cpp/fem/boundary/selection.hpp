#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// Where a support or a load acts: the union of named faces, boundary triangles (rows of
// TetMesh::boundary) and single nodes.
struct Selection {
  std::vector<std::string> faces;
  std::vector<int> triangles;
  std::vector<int> nodes;
};

// Rows of TetMesh::boundary, sorted. Throws ModelError for an unknown face (the message lists the
// known ones) or when nothing is selected, std::invalid_argument for an index out of range.
std::vector<int> selected_triangles(const TetMesh& mesh, const Selection& selection);

// All nodes of the selected triangles and the selected nodes, sorted.
std::vector<int> selected_nodes(const TetMesh& mesh, const Selection& selection);

// The boundary as a surface of flat triangles, over all nodes of the mesh.
SurfaceMesh boundary_surface(const TetMesh& mesh);

// The smooth face nearest to a point, see smooth_patch.hpp.
std::vector<int> triangles_near(const TetMesh& mesh, const Eigen::Vector3d& point, double max_bend);

// Triangles with all six nodes in the box.
std::vector<int> triangles_in_box(const TetMesh& mesh, const Eigen::Vector3d& lower,
                                  const Eigen::Vector3d& upper);

// Triangles whose outward normal is within angle (rad) of the given direction.
std::vector<int> triangles_with_normal(const TetMesh& mesh, const Eigen::Vector3d& normal,
                                       double angle);

}  // namespace codesign::fem
