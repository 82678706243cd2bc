#include "fem/la/symbolic_factor.hpp"

#include <cholmod.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "fem/la/factor_structure.hpp"

// The fields filled below have the same names and types in CHOLMOD 3 to 5 (SuiteSparse 5 to 7).
static_assert(CHOLMOD_MAIN_VERSION >= 3 && CHOLMOD_MAIN_VERSION <= 5,
              "compare cholmod_factor with symbolic_factor, or use cholmod_analyze_p instead");

namespace codesign::fem {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// What CHOLMOD wants to know beside the rows.
struct Extent {
  std::vector<int> px;  // (s + 1) first entry of each supernode
  // Largest update of a later supernode by an earlier one, and most rows below a supernode.
  std::size_t max_update = 1, max_below = 1;
};

Extent extent_of(const FactorStructure& structure) {
  Extent out;
  const std::vector<int> supernode_of = structure.supernode_of();
  out.px.push_back(0);
  for (int s = 0; s < structure.count(); ++s) {
    const int *row = structure.rows(s) + structure.width(s),
              *end = structure.rows(s) + structure.height(s);
    out.px.push_back(out.px.back() + structure.width(s) * structure.height(s));
    out.max_below = std::max(out.max_below, static_cast<std::size_t>(end - row));
    while (row != end) {
      const int target = supernode_of[at(*row)];
      const auto below = static_cast<std::size_t>(end - row);
      std::size_t wide = 0;
      for (; row != end && supernode_of[at(*row)] == target; ++row) ++wide;
      out.max_update = std::max(out.max_update, wide * below);
    }
  }
  return out;
}

// A copy in CHOLMOD's own memory, as its factor frees it; null and a status where there is none.
void* copy_for_cholmod(const std::vector<int>& values, cholmod_common& common) {
  void* memory = cholmod_malloc(values.size(), sizeof(int), &common);
  if (memory != nullptr) std::copy(values.begin(), values.end(), static_cast<int*>(memory));
  return memory;
}

}  // namespace

cholmod_factor* symbolic_factor(const NodePattern& pattern, cholmod_common& common) {
  if (pattern.supernodes.entries > std::numeric_limits<int>::max()) {
    common.status = CHOLMOD_TOO_LARGE;
    return nullptr;
  }
  const FactorStructure structure = factor_structure(pattern);
  const Extent extent = extent_of(structure);
  cholmod_factor* l = cholmod_allocate_factor(at(pattern.equations()), &common);
  if (l == nullptr) return nullptr;
  l->ordering = CHOLMOD_NATURAL;
  l->is_super = 1;
  l->is_ll = 1;
  l->is_monotonic = 1;
  l->xtype = CHOLMOD_PATTERN;
  l->nsuper = at(structure.count());
  l->ssize = structure.row.size();
  l->xsize = at(extent.px.back());
  l->maxcsize = extent.max_update;
  l->maxesize = extent.max_below;
  l->super = copy_for_cholmod(structure.first, common);
  l->pi = copy_for_cholmod(structure.row_start, common);
  l->px = copy_for_cholmod(extent.px, common);
  l->s = copy_for_cholmod(structure.row, common);
  if (common.status != CHOLMOD_OK) cholmod_free_factor(&l, &common);
  return l;
}

}  // namespace codesign::fem
