#include "fem/elasticity/memory.hpp"

#include <array>
#include <cstdio>
#include <limits>

#include "errors.hpp"

namespace codesign::fem {

double matrix_bytes(const NodePattern& pattern) {
  const double pairs = static_cast<double>(pattern.neighbor.size());
  const double entries = 9.0 * pairs + 6.0 * pattern.positions();
  return entries * (sizeof(double) + sizeof(int));
}

double factor_bytes(const NodePattern& pattern) {
  return sizeof(double) * pattern.supernodes.entries;
}

bool factor_fits(const NodePattern& pattern, const FactorLimits& limits) {
  return matrix_bytes(pattern) + factor_bytes(pattern) <= limits.memory &&
         pattern.supernodes.entries < std::numeric_limits<int>::max() &&
         pattern.supernodes.operations <= limits.operations;
}

void require_memory(double bytes, double memory_limit, int nodes) {
  if (bytes <= memory_limit) return;
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(),
                "the analysis of a mesh of %d nodes needs about %.0f MiB, its memory limit is %.0f "
                "MiB: larger elements or a larger limit (memory_limit; fem.memory_limit_mib of a "
                "study) are needed",
                nodes, bytes / (1 << 20), memory_limit / (1 << 20));
  throw MemoryLimitError(text.data());
}

}  // namespace codesign::fem
