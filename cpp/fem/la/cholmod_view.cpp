#include "fem/la/cholmod_view.hpp"

#include <cholmod.h>

#include <cstddef>

namespace codesign::fem {

cholmod_sparse_struct cholmod_view(const LowerMatrix& a) {
  cholmod_sparse s{};
  s.nrow = s.ncol = static_cast<std::size_t>(a.size());
  s.nzmax = a.row.size();
  s.p = const_cast<int*>(a.start.data());
  s.i = const_cast<int*>(a.row.data());
  s.x = const_cast<double*>(a.value.data());
  s.stype = -1;
  s.itype = CHOLMOD_INT;
  s.xtype = CHOLMOD_REAL;
  s.dtype = CHOLMOD_DOUBLE;
  s.sorted = 1;
  s.packed = 1;
  return s;
}

}  // namespace codesign::fem
