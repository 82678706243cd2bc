#pragma once

#include "fem/la/ordering.hpp"

// What an analysis needs to hold, known from the pattern before anything is assembled.
namespace codesign::fem {

inline constexpr double kMemoryLimit = 4e9;  // bytes, for the matrices and factors of one analysis

// Bytes of the matrices of a pattern.
double matrix_bytes(const NodePattern& pattern);  // of the stiffness
double factor_bytes(const NodePattern& pattern);  // of its Cholesky factor

// Whether stiffness and factor fit into the limit and the factorization takes no more multiply-adds
// than `operations`.
bool factor_fits(const NodePattern& pattern, double memory_limit, double operations);

// Throws MemoryLimitError if an analysis of `nodes` nodes needs more bytes than the limit.
void require_memory(double bytes, double memory_limit, int nodes);

}  // namespace codesign::fem
