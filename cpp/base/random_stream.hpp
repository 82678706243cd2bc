#pragma once

#include <cstdint>

namespace codesign {

// Random numbers that are the same bits on every machine with IEEE doubles: SplitMix64 (Steele,
// Lea, Flood, OOPSLA 2014) for the integers, their upper 53 bits over 2⁵³ for uniform numbers in
// [0, 1), and the sum of twelve of these minus six for nearly normal ones (mean 0, variance 1,
// within ±6): additions only, no library function whose last digit may differ.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

  double normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }

 private:
  std::uint64_t state_;
};

}  // namespace codesign
