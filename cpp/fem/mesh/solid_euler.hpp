#pragma once

#include "fem/mesh/tet_neighbors.hpp"

namespace codesign::fem {

// Euler characteristic of the solid that tetrahedra fill, in which points and edges count once for
// each group of tetrahedra about them that hang together by sides: where its boundary only touches
// itself, the solid does not. Half the sum of the characteristics of the surfaces that bound it.
int solid_euler(const Eigen::Ref<const Tets4, 0, Eigen::OuterStride<>>& tets);

}  // namespace codesign::fem
