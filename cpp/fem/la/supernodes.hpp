#pragma once

#include <vector>

namespace codesign::fem {

// Groups of consecutive columns of a Cholesky factor that share one row pattern.
struct Supernodes {
  std::vector<int> start;      // (s + 1) first column of a supernode
  std::vector<int> row_start;  // (s + 1) into row
  std::vector<int> row;        // rows below the supernode's own columns, ascending
  double operations = 0.0;     // of the factorization, multiply-adds
  double entries = 0.0;        // of the factor, the supernodes' upper triangles included

  int count() const { return static_cast<int>(start.size()) - 1; }
};

// An order of elimination and the supernodes it has.
struct Elimination {
  std::vector<int> order;  // order[k] = old index eliminated k-th
  Supernodes supernodes;   // in the new order
};

// Symbolic factorization of a symmetric graph: start and neighbor hold the neighbors > k of k,
// ascending; weight is the number of equations of each index. Finds the elimination tree and its
// supernodes, merges small supernodes into their parents where this costs few explicit zeros (so
// that the numerical work is in larger dense blocks), and reorders the columns so that the merged
// ones are consecutive and every subtree is contiguous: the fill stays what the given order has.
Elimination analyze(const std::vector<int>& start, const std::vector<int>& neighbor,
                    const std::vector<int>& weight);

}  // namespace codesign::fem
