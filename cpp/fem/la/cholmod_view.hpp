#pragma once

#include "fem/la/lower_matrix.hpp"

struct cholmod_sparse_struct;  // CHOLMOD's own, of cholmod.h

namespace codesign::fem {

// A symmetric matrix as CHOLMOD sees it: read in place, so it must outlive the view; CHOLMOD never
// writes to it.
cholmod_sparse_struct cholmod_view(const LowerMatrix& a);

}  // namespace codesign::fem
