#pragma once

#include <algorithm>
#include <vector>

#include "fem/la/ordering.hpp"

namespace codesign::fem {

// A supernodal Cholesky factor of the equations, without its values: each supernode is a dense
// block, its own columns by its rows.
struct FactorStructure {
  std::vector<int> first;      // (s + 1) first column of a supernode
  std::vector<int> row_start;  // (s + 1) into row
  std::vector<int> row;        // equations of a supernode's rows, ascending, its own columns first

  int count() const { return static_cast<int>(first.size()) - 1; }
  int width(int s) const { return first[at(s + 1)] - first[at(s)]; }
  int height(int s) const { return row_start[at(s + 1)] - row_start[at(s)]; }
  const int* rows(int s) const { return row.data() + row_start[at(s)]; }
  // (equations) the supernode whose column each is.
  std::vector<int> supernode_of() const;
  int tallest() const {
    int most = 0;
    for (int s = 0; s < count(); ++s) most = std::max(most, height(s));
    return most;
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
};

// That of the pattern's supernodes.
FactorStructure factor_structure(const NodePattern& pattern);

}  // namespace codesign::fem
