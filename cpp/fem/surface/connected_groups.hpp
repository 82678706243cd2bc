#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace codesign::fem {

// Groups of items that hang together over their neighbors (-1: none): the group of each item,
// numbered by its first item, and how many groups there are. `joined(item, k)` says whether the
// k-th neighbor counts.
template <class Neighbors, class Joined>
std::pair<std::vector<int>, int> connected_groups(const Neighbors& neighbors, Joined joined) {
  std::vector<int> group(neighbors.size(), -1);
  std::vector<int> stack;
  int groups = 0;
  for (std::size_t seed = 0; seed < neighbors.size(); ++seed) {
    if (group[seed] >= 0) continue;
    group[seed] = groups;
    stack.push_back(static_cast<int>(seed));
    while (!stack.empty()) {
      const auto item = static_cast<std::size_t>(stack.back());
      stack.pop_back();
      for (std::size_t k = 0; k < neighbors[item].size(); ++k) {
        const int other = neighbors[item][k];
        if (other < 0 || group[static_cast<std::size_t>(other)] >= 0 || !joined(item, k)) continue;
        group[static_cast<std::size_t>(other)] = groups;
        stack.push_back(other);
      }
    }
    ++groups;
  }
  return {group, groups};
}

// The same where all neighbors are joined.
template <class Neighbors>
std::pair<std::vector<int>, int> connected_groups(const Neighbors& neighbors) {
  return connected_groups(neighbors, [](std::size_t, std::size_t) { return true; });
}

}  // namespace codesign::fem
