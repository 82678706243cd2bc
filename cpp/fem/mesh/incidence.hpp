#pragma once

#include <vector>

#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// Elements that a node belongs to: element[start[n] ... start[n + 1]), ascending.
struct Incidence {
  std::vector<int> start, element;
};

// Over the first `local_nodes` nodes of each element: 4 for corners only, 10 for all.
Incidence elements_of_nodes(const TetMesh& mesh, int local_nodes);

}  // namespace codesign::fem
