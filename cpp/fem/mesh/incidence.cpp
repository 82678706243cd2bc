#include "fem/mesh/incidence.hpp"

#include <numeric>

namespace codesign::fem {

Incidence elements_of_nodes(const TetMesh& mesh, int local_nodes) {
  const auto at = [](Eigen::Index i) { return static_cast<std::size_t>(i); };
  Incidence result;
  result.start.assign(at(mesh.nodes.rows()) + 1, 0);
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    for (int i = 0; i < local_nodes; ++i) ++result.start[at(mesh.tets(e, i)) + 1];
  }
  std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
  result.element.resize(at(result.start.back()));
  std::vector<int> next(result.start.begin(), result.start.end() - 1);
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    for (int i = 0; i < local_nodes; ++i) result.element[at(next[at(mesh.tets(e, i))]++)] = e;
  }
  return result;
}

}  // namespace codesign::fem
