#pragma once

#include "fem/la/ordering.hpp"

// What an analysis needs to hold, known from the pattern before anything is assembled.
namespace codesign::fem {

inline constexpr double kMemoryLimit = 4e9;  // bytes, for the matrices and factors of one analysis

// Bytes of the matrices of a pattern.
double matrix_bytes(const NodePattern& pattern);  // of the stiffness
double factor_bytes(const NodePattern& pattern);  // of its Cholesky factor

// What a factorization may take.
struct FactorLimits {
  double memory = kMemoryLimit;  // bytes, of stiffness and factor
  double operations = 0.0;       // multiply-adds
};

// Whether stiffness and factor of a pattern are within the limits.
bool factor_fits(const NodePattern& pattern, const FactorLimits& limits);

// Throws MemoryLimitError if an analysis of `nodes` nodes needs more bytes than the limit.
void require_memory(double bytes, double memory_limit, int nodes);

}  // namespace codesign::fem
