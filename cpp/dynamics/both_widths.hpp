#pragma once

// CODESIGN_BOTH_WIDTHS before a function: compiled twice, for AVX2 and for what every machine has,
// and picked when the library loads. AVX2 alone has no fused multiply-add, so both round alike.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define CODESIGN_BOTH_WIDTHS __attribute__((target_clones("avx2", "default")))
#else
#define CODESIGN_BOTH_WIDTHS
#endif
