#include "fem/la/symbolic_factor.hpp"

#include <cholmod.h>

#include <algorithm>
#include <limits>
#include <vector>

// The fields filled below are CHOLMOD 3's (SuiteSparse 5); later versions changed types among them.
static_assert(CHOLMOD_MAIN_VERSION == 3,
              "compare cholmod_factor with symbolic_factor, or use cholmod_analyze_p instead");

namespace codesign::fem {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

cholmod_factor* symbolic_factor(const NodePattern& pattern, cholmod_common& common) {
  const Supernodes& nodes = pattern.supernodes;
  const std::size_t n = at(pattern.equations()), count = at(nodes.count());
  cholmod_factor* l = cholmod_allocate_factor(n, &common);
  if (l == nullptr) return nullptr;
  const auto equations_of_rows = [&](int s) {
    int sum = 0;
    for (int p = nodes.row_start[at(s)]; p < nodes.row_start[at(s) + 1]; ++p) {
      const int row = nodes.row[at(p)];
      sum += pattern.dof_start[at(row) + 1] - pattern.dof_start[at(row)];
    }
    return sum;
  };
  std::vector<int> super(count + 1), pi(count + 1, 0), px(count + 1, 0), rows;
  std::vector<int> supernode_of(at(pattern.positions()));
  std::size_t entries = 0;
  for (std::size_t s = 0; s < count; ++s) {
    const int first = nodes.start[s], last = nodes.start[s + 1];
    for (int k = first; k < last; ++k) supernode_of[at(k)] = static_cast<int>(s);
    const int columns = pattern.dof_start[at(last)] - pattern.dof_start[at(first)];
    const int height = columns + equations_of_rows(static_cast<int>(s));
    super[s] = pattern.dof_start[at(first)];
    pi[s + 1] = pi[s] + height;
    entries += static_cast<std::size_t>(height) * at(columns);
    if (entries > std::numeric_limits<int>::max()) {
      cholmod_free_factor(&l, &common);
      common.status = CHOLMOD_TOO_LARGE;
      return nullptr;
    }
    px[s + 1] = static_cast<int>(entries);
  }
  super[count] = static_cast<int>(n);
  rows.reserve(at(pi[count]));
  // Largest update of a later supernode by an earlier one, and most rows below a supernode.
  std::size_t max_update = 1, max_below = 1;
  for (std::size_t s = 0; s < count; ++s) {
    for (int d = super[s]; d < super[s + 1]; ++d) rows.push_back(d);
    std::size_t below = at(pi[s + 1] - pi[s] - (super[s + 1] - super[s]));
    max_below = std::max(max_below, below);
    int p = nodes.row_start[s];
    while (p < nodes.row_start[s + 1]) {
      const int target = supernode_of[at(nodes.row[at(p)])];
      std::size_t wide = 0;
      for (; p < nodes.row_start[s + 1] && supernode_of[at(nodes.row[at(p)])] == target; ++p) {
        const int row = nodes.row[at(p)];
        for (int d = pattern.dof_start[at(row)]; d < pattern.dof_start[at(row) + 1]; ++d) {
          rows.push_back(d);
          ++wide;
        }
      }
      max_update = std::max(max_update, wide * below);
      below -= wide;
    }
  }
  const auto give = [&](const std::vector<int>& values) {
    void* memory = cholmod_malloc(values.size(), sizeof(int), &common);
    if (memory != nullptr) std::copy(values.begin(), values.end(), static_cast<int*>(memory));
    return memory;
  };
  l->ordering = CHOLMOD_NATURAL;
  l->is_super = 1;
  l->is_ll = 1;
  l->is_monotonic = 1;
  l->xtype = CHOLMOD_PATTERN;
  l->nsuper = count;
  l->ssize = rows.size();
  l->xsize = entries;
  l->maxcsize = max_update;
  l->maxesize = max_below;
  l->super = give(super);
  l->pi = give(pi);
  l->px = give(px);
  l->s = give(rows);
  if (common.status != CHOLMOD_OK) cholmod_free_factor(&l, &common);
  return l;
}

}  // namespace codesign::fem
