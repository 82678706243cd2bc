#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace codesign::fem {

// Items that are joined one pair after the other.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t items) : parent_(items), sets_(items) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  // The item that stands for the set of this one.
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void join(std::size_t i, std::size_t j) {
    const std::size_t from = find(i), to = find(j);
    sets_ -= from != to;
    parent_[from] = to;
  }

  // How many there are.
  std::size_t count() const { return sets_; }

 private:
  std::vector<std::size_t> parent_;
  std::size_t sets_;
};

}  // namespace codesign::fem
