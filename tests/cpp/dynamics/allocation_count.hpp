#pragma once

#include <atomic>
#include <cstddef>

// Counts every malloc of the test executable that includes this (one source file each). Eigen and
// operator new both end in malloc, so nothing escapes.
inline std::atomic<long> allocation_count{0};

#if defined(__SANITIZE_ADDRESS__) || !defined(__GLIBC__)
inline constexpr bool kAllocationsAreCounted = false;  // a sanitizer owns malloc
#else
inline constexpr bool kAllocationsAreCounted = true;
extern "C" void* __libc_malloc(std::size_t size);  // NOLINT: glibc's name
extern "C" void* malloc(std::size_t size) {
  ++allocation_count;
  return __libc_malloc(size);
}
#endif
