#pragma once

#include <vector>

#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// Where a node lies: off the edges of the body, on one, or where at least three of them meet.
enum class BodyPlace : char { smooth, edge, corner };

// Place of every node; mid-edge ones are never corners. An edge of the body is one of the boundary
// whose sides turn by more than kBodyEdge there, however their elements are curved.
constexpr double kBodyEdge = 0.5235987755982988;  // 30 degrees
std::vector<BodyPlace> body_places(const TetMesh& mesh);

}  // namespace codesign::fem
