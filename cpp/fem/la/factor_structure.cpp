#include "fem/la/factor_structure.hpp"

#include <algorithm>
#include <cstddef>

namespace codesign::fem {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

std::vector<int> FactorStructure::supernode_of() const {
  std::vector<int> found(at(first.back()));
  for (int s = 0; s < count(); ++s)
    std::fill(found.begin() + first[at(s)], found.begin() + first[at(s + 1)], s);
  return found;
}

FactorStructure factor_structure(const NodePattern& pattern) {
  const Supernodes& nodes = pattern.supernodes;
  FactorStructure out;
  out.first.reserve(at(nodes.count() + 1));
  out.row_start.reserve(at(nodes.count() + 1));
  out.row_start.push_back(0);
  for (int s = 0; s < nodes.count(); ++s) {
    const int begin = pattern.dof_start[at(nodes.start[at(s)])];
    const int end = pattern.dof_start[at(nodes.start[at(s + 1)])];
    out.first.push_back(begin);
    for (int d = begin; d < end; ++d) out.row.push_back(d);
    for (int p = nodes.row_start[at(s)]; p < nodes.row_start[at(s + 1)]; ++p) {
      const int k = nodes.row[at(p)];
      for (int d = pattern.dof_start[at(k)]; d < pattern.dof_start[at(k + 1)]; ++d)
        out.row.push_back(d);
    }
    out.row_start.push_back(static_cast<int>(out.row.size()));
  }
  out.first.push_back(pattern.equations());
  return out;
}

}  // namespace codesign::fem
