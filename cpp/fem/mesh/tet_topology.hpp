#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fem/mesh/tet_mesh.hpp"
#include "fem/mesh/tet_neighbors.hpp"

namespace codesign::fem {

// Quadratic mesh of a user's linear tetrahedra: adds straight mid-edge nodes after the given nodes
// and the boundary (one unnamed face). Elements given inside out are turned over. Throws MeshError
// for indices out of range, flat elements, nodes without element, or a side shared by more than two
// elements.
TetMesh make_tet_mesh(const Points& nodes, const Tets4& tets);

// The same for ten-node tetrahedra, mid-edge nodes on edges 01 12 02 03 13 23. Throws MeshError
// also if such a node is far from the middle of its edge.
TetMesh make_tet_mesh(const Points& nodes, const Tets10& tets);

// Boundary sides of one named face, by their corner nodes in any order.
struct NamedSides {
  std::string name;
  Triangles sides;
};

// Names faces of the boundary; sides that are not mentioned stay in an unnamed face. Throws
// MeshError for a side that is not on the boundary or is mentioned twice.
void name_faces(TetMesh& mesh, const std::vector<NamedSides>& faces);

}  // namespace codesign::fem
