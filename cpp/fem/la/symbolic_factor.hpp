#pragma once

#include "fem/la/ordering.hpp"

// CHOLMOD's own types, of cholmod.h.
struct cholmod_common_struct;
struct cholmod_factor_struct;

namespace codesign::fem {

// The pattern's supernodes as CHOLMOD's symbolic factor, in the natural order. cholmod_analyze_p of
// the equations in place of ours of the nodes costs 4 to 9 % of a part's time
// (docs/decisions/0009-symbolic-factor.md). A null pointer and the reason in common.status if
// memory runs out or the factor is too large. To be freed with cholmod_free_factor.
cholmod_factor_struct* symbolic_factor(const NodePattern& pattern, cholmod_common_struct& common);

}  // namespace codesign::fem
