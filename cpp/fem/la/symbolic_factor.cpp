#include "fem/la/symbolic_factor.hpp"

#include <cholmod.h>

#include <algorithm>
#include <limits>
#include <vector>

// The fields filled below have the same names and types in CHOLMOD 3 to 5 (SuiteSparse 5 to 7).
static_assert(CHOLMOD_MAIN_VERSION >= 3 && CHOLMOD_MAIN_VERSION <= 5,
              "compare cholmod_factor with symbolic_factor, or use cholmod_analyze_p instead");

namespace codesign::fem {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// The arrays of a supernodal factor: first column, first row index and first entry of each
// supernode, then the rows of all.
struct Structure {
  std::vector<int> super, pi, px, rows;
  std::size_t entries = 0;
  // Largest update of a later supernode by an earlier one, and most rows below a supernode.
  std::size_t max_update = 1, max_below = 1;
};

int degrees_of(const NodePattern& pattern, int first, int last) {
  return pattern.dof_start[at(last)] - pattern.dof_start[at(first)];
}

// False where there are more entries than CHOLMOD's indices reach.
bool count_entries(const NodePattern& pattern, Structure& out) {
  const Supernodes& nodes = pattern.supernodes;
  const std::size_t count = at(nodes.count());
  out.super.resize(count + 1);
  out.pi.assign(count + 1, 0);
  out.px.assign(count + 1, 0);
  for (std::size_t s = 0; s < count; ++s) {
    const int columns = degrees_of(pattern, nodes.start[s], nodes.start[s + 1]);
    int height = columns;
    for (int p = nodes.row_start[s]; p < nodes.row_start[s + 1]; ++p)
      height += degrees_of(pattern, nodes.row[at(p)], nodes.row[at(p)] + 1);
    out.super[s] = pattern.dof_start[at(nodes.start[s])];
    out.pi[s + 1] = out.pi[s] + height;
    out.entries += at(height) * at(columns);
    if (out.entries > std::numeric_limits<int>::max()) return false;
    out.px[s + 1] = static_cast<int>(out.entries);
  }
  out.super[count] = pattern.equations();
  return true;
}

void list_rows(const NodePattern& pattern, Structure& out) {
  const Supernodes& nodes = pattern.supernodes;
  const std::size_t count = at(nodes.count());
  std::vector<int> supernode_of(at(pattern.positions()));
  for (std::size_t s = 0; s < count; ++s)
    for (int k = nodes.start[s]; k < nodes.start[s + 1]; ++k)
      supernode_of[at(k)] = static_cast<int>(s);
  out.rows.reserve(at(out.pi[count]));
  for (std::size_t s = 0; s < count; ++s) {
    for (int d = out.super[s]; d < out.super[s + 1]; ++d) out.rows.push_back(d);
    std::size_t below = at(out.pi[s + 1] - out.pi[s] - (out.super[s + 1] - out.super[s]));
    out.max_below = std::max(out.max_below, below);
    int p = nodes.row_start[s];
    while (p < nodes.row_start[s + 1]) {
      const int target = supernode_of[at(nodes.row[at(p)])];
      const std::size_t before = out.rows.size();
      for (; p < nodes.row_start[s + 1] && supernode_of[at(nodes.row[at(p)])] == target; ++p) {
        const int row = nodes.row[at(p)];
        for (int d = pattern.dof_start[at(row)]; d < pattern.dof_start[at(row) + 1]; ++d)
          out.rows.push_back(d);
      }
      const std::size_t wide = out.rows.size() - before;
      out.max_update = std::max(out.max_update, wide * below);
      below -= wide;
    }
  }
}

// A copy in CHOLMOD's own memory, as its factor frees it; null and a status where there is none.
void* copy_for_cholmod(const std::vector<int>& values, cholmod_common& common) {
  void* memory = cholmod_malloc(values.size(), sizeof(int), &common);
  if (memory != nullptr) std::copy(values.begin(), values.end(), static_cast<int*>(memory));
  return memory;
}

}  // namespace

cholmod_factor* symbolic_factor(const NodePattern& pattern, cholmod_common& common) {
  Structure structure;
  if (!count_entries(pattern, structure)) {
    common.status = CHOLMOD_TOO_LARGE;
    return nullptr;
  }
  list_rows(pattern, structure);
  cholmod_factor* l = cholmod_allocate_factor(at(pattern.equations()), &common);
  if (l == nullptr) return nullptr;
  l->ordering = CHOLMOD_NATURAL;
  l->is_super = 1;
  l->is_ll = 1;
  l->is_monotonic = 1;
  l->xtype = CHOLMOD_PATTERN;
  l->nsuper = at(pattern.supernodes.count());
  l->ssize = structure.rows.size();
  l->xsize = structure.entries;
  l->maxcsize = structure.max_update;
  l->maxesize = structure.max_below;
  l->super = copy_for_cholmod(structure.super, common);
  l->pi = copy_for_cholmod(structure.pi, common);
  l->px = copy_for_cholmod(structure.px, common);
  l->s = copy_for_cholmod(structure.rows, common);
  if (common.status != CHOLMOD_OK) cholmod_free_factor(&l, &common);
  return l;
}

}  // namespace codesign::fem
