#pragma once

#include <cstdint>

namespace codesign::fem {

// Key of an undirected edge between two nodes.
inline std::uint64_t edge_key(int a, int b) {
  const auto low = static_cast<std::uint32_t>(a < b ? a : b);
  const auto high = static_cast<std::uint32_t>(a < b ? b : a);
  return std::uint64_t{high} << 32 | low;
}

}  // namespace codesign::fem
