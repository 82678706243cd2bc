#include <gtest/gtest.h>

#include "box_mesh.hpp"
#include "fem/mesh/boundary_neighbors.hpp"
#include "fem/surface/topology.hpp"

namespace codesign::fem {
namespace {

Triangles corners(const TetMesh& mesh) { return mesh.boundary.leftCols<3>(); }

TEST(BoundaryNeighbors, AgreeWithSharedEdgesOnAManifold) {
  const TetMesh mesh = box_mesh(2, 3, 2);
  EXPECT_EQ(measure_topology(corners(mesh), boundary_neighbors(mesh)),
            measure_topology(corners(mesh)));
}

TEST(BoundaryNeighbors, FollowTheMaterialAtASharedEdge) {
  Points nodes(6, 3);
  nodes << 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0;
  Tets4 tets(2, 4);
  tets << 0, 1, 2, 3, 0, 1, 4, 5;
  const TetMesh mesh = make_tet_mesh(nodes, tets);
  EXPECT_EQ(measure_topology(corners(mesh)).open_edges, 4);
  const Topology opened = measure_topology(corners(mesh), boundary_neighbors(mesh));
  EXPECT_EQ(opened.euler, (std::vector<int>{2, 2}));
  EXPECT_EQ(opened.open_edges, 0);
}

}  // namespace
}  // namespace codesign::fem
