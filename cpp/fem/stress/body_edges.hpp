#pragma once

#include <vector>

#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// Where a node lies: off the edges of the body, on one, or where at least three of them meet; a tip
// is such a corner that a single element fills.
enum class BodyPlace : char { smooth, edge, corner, tip };

// Place of every node, of the mesh alone; mid-edge ones are never corners. An edge of the body is
// one of the boundary whose sides turn by more than kBodyEdge there, however their elements are
// curved.
constexpr double kBodyEdge = 0.5235987755982988;  // 30 degrees
std::vector<BodyPlace> body_places(const TetMesh& mesh);

}  // namespace codesign::fem
