#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// Four-node tetrahedra with labeled boundary sides, as they come from the mesher and before mid
// nodes are added.
struct LinearTets {
  std::vector<Eigen::Vector3d> points;   // m
  std::vector<int> dimension;            // of their place: 0 corner, 1 line, 2 surface, 3 inside
  std::vector<std::array<int, 4>> tets;  // positive volume
  std::vector<std::array<int, 4>> side_label;  // of the side opposite to each corner; -1 inside
};

// Keeps the tetrahedra for which keep[t] holds, in their order; all points stay.
void keep_only(LinearTets& mesh, const std::vector<bool>& keep);

// Removes flat tetrahedra that lie on the boundary with two sides of one label: such an element has
// no volume worth mentioning but falsifies stiffness and stress. A tetrahedron goes if one of its
// dihedral angles is below `flat_angle`, two of its sides are boundary sides of the same label that
// meet at more than `straight_angle`, and the opposite edge is not on the boundary already; its
// other two sides then become boundary. Repeated until none is left. Returns how many were removed.
// [rad]
int peel_flat_tets(LinearTets& mesh, double flat_angle, double straight_angle);

// Removes pieces that touch the largest one in a point or an edge only and have less than
// `fraction` of its volume: the mesher leaves such crumbs of a few elements beside narrow ledges.
// Larger pieces stay (the caller refuses them). Returns the number of tetrahedra removed.
int remove_crumbs(LinearTets& mesh, double fraction);

// The quadratic mesh with the same labels as faces; unused points are left out.
TetMesh to_quadratic(const LinearTets& mesh, const std::vector<std::string>& face_names);

}  // namespace codesign::fem
