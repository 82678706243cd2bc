#include "dynamics/dense_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "dynamics/both_widths.hpp"

namespace codesign::dynamics {

namespace {

// Four rows of a column: one AVX register or two of SSE2.
using Four = double __attribute__((vector_size(32)));
constexpr int kRows = 4;

// Columns of A that are scaled at a time; a multiple of the three that add_outer_product sums
// first.
constexpr int kChunk = 48;

// Rows of a column: four of them, or one as a plain double.
template <class Rows>
__attribute__((always_inline)) inline void load(const double* from, Rows& rows) {
  std::memcpy(&rows, from, sizeof(rows));
}

__attribute__((always_inline)) inline void store(const Four& rows, double* to) {
  std::memcpy(to, &rows, sizeof(rows));
}

// Rows of a column of C, those where `a` starts: + Σ_k f_k a_k.
template <class Rows>
__attribute__((always_inline)) inline void add_columns(const double* a, int m, int a_stride,
                                                       const double* f, Rows& sum) {
  Rows x, y, z;
  int k = 0;
  for (; k + 3 <= m; k += 3) {
    load(a + k * a_stride, x);
    load(a + (k + 1) * a_stride, y);
    load(a + (k + 2) * a_stride, z);
    sum += f[k] * x + f[k + 1] * y + f[k + 2] * z;
  }
  for (; k < m; ++k) {
    load(a + k * a_stride, x);
    sum += f[k] * x;
  }
}

// Rows of column j of a matrix whose first j columns are factored: − Σ_k l_k a_k, k < j; `row` is
// where those of column 0 start.
template <class Rows>
__attribute__((always_inline)) inline void take_columns(const double* a, int row, int j, int stride,
                                                        Rows& sum) {
  Rows w, x, y, z;
  int k = 0;
  for (; k + 4 <= j; k += 4) {
    const double* c0 = a + k * stride;
    const double* c1 = c0 + stride;
    const double* c2 = c1 + stride;
    const double* c3 = c2 + stride;
    load(c0 + row, w);
    load(c1 + row, x);
    load(c2 + row, y);
    load(c3 + row, z);
    sum -= (c0[j] * w + c1[j] * x) + (c2[j] * y + c3[j] * z);
  }
  for (; k < j; ++k) {
    const double* c = a + k * stride;
    load(c + row, w);
    sum -= c[j] * w;
  }
}

// 1 / √pivot; zero if that is not a positive finite number.
inline double inverse_root(double pivot) {
  if (!(pivot > 0.0)) return 0.0;
  const double inverse = 1.0 / std::sqrt(pivot);
  return std::isfinite(inverse) ? inverse : 0.0;
}

}  // namespace

// Column by column, four rows at a time from the last row up. The top four rows of a column may
// overlap the four below: they are summed first and stored last, so that both start from the same
// C. The last columns, shorter than four rows, go row by row.
CODESIGN_BOTH_WIDTHS
void add_outer_product(double* c, int n, int c_stride, const double* a, int m, int a_stride,
                       double factor) {
  double f[kChunk];
  for (int start = 0; start < m; start += kChunk, a += kChunk * a_stride) {
    const int chunk = std::min(kChunk, m - start);
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < chunk; ++k) f[k] = factor * a[k * a_stride + j];
      double* column = c + j * c_stride;
      if (j + kRows > n) {
        for (int i = j; i < n; ++i) add_columns(a + i, chunk, a_stride, f, column[i]);
        continue;
      }
      Four top, sum;
      load(column + j, top);
      add_columns(a + j, chunk, a_stride, f, top);
      for (int i = n - kRows; i > j; i -= kRows) {
        load(column + i, sum);
        add_columns(a + i, chunk, a_stride, f, sum);
        store(sum, column + i);
      }
      store(top, column + j);
    }
  }
}

// Rows as those of one column of add_outer_product.
CODESIGN_BOTH_WIDTHS
void add_product(const double* a, int n, int m, int stride, const double* x, double* y) {
  if (n < kRows) {
    for (int i = 0; i < n; ++i) add_columns(a + i, m, stride, x, y[i]);
    return;
  }
  Four top, sum;
  load(y, top);
  add_columns(a, m, stride, x, top);
  for (int i = n - kRows; i > 0; i -= kRows) {
    load(y + i, sum);
    add_columns(a + i, m, stride, x, sum);
    store(sum, y + i);
  }
  store(top, y);
}

CODESIGN_BOTH_WIDTHS
void add_transposed_product(const double* a, int n, int m, int stride, const double* x, double* y) {
  for (int j = 0; j < m; ++j, a += stride) {
    Four sum = {0.0, 0.0, 0.0, 0.0}, p, q;
    int i = 0;
    for (; i + kRows <= n; i += kRows) {
      load(a + i, p);
      load(x + i, q);
      sum += p * q;
    }
    double rest = 0.0;
    for (; i < n; ++i) rest += a[i] * x[i];
    y[j] += ((sum[0] + sum[2]) + (sum[1] + sum[3])) + rest;
  }
}

// Columns from the left; rows of each as in add_outer_product.
CODESIGN_BOTH_WIDTHS
bool cholesky_in_place(double* a, int m, int stride) {
  int j = 0;
  for (; j + kRows <= m; ++j) {
    double* column = a + j * stride;
    Four top, sum;
    load(column + j, top);
    take_columns(a, j, j, stride, top);
    const double inverse = inverse_root(top[0]);
    if (inverse == 0.0) return false;
    for (int i = m - kRows; i > j; i -= kRows) {
      load(column + i, sum);
      take_columns(a, i, j, stride, sum);
      store(sum * inverse, column + i);
    }
    top *= inverse;
    top[0] = inverse;
    store(top, column + j);
  }
  for (; j < m; ++j) {
    double* column = a + j * stride;
    for (int i = j; i < m; ++i) take_columns(a, i, j, stride, column[i]);
    const double inverse = inverse_root(column[j]);
    if (inverse == 0.0) return false;
    for (int i = j + 1; i < m; ++i) column[i] *= inverse;
    column[j] = inverse;
  }
  return true;
}

void cholesky_solve(const double* a, int m, int stride, double* b) {
  for (int j = 0; j < m; ++j) {
    const double* column = a + j * stride;
    const double x = b[j] * column[j];
    b[j] = x;
    for (int i = j + 1; i < m; ++i) b[i] -= x * column[i];
  }
  for (int j = m - 1; j >= 0; --j) {
    const double* column = a + j * stride;
    double even = 0.0, odd = 0.0;
    int i = j + 1;
    for (; i + 2 <= m; i += 2) {
      even += column[i] * b[i];
      odd += column[i + 1] * b[i + 1];
    }
    if (i < m) even += column[i] * b[i];
    b[j] = (b[j] - (even + odd)) * column[j];
  }
}

bool lu_in_place(double* a, int m, int stride, int* pivots) {
  for (int j = 0; j < m; ++j) {
    double* column = a + j * stride;
    int pivot = j;
    for (int i = j + 1; i < m; ++i) {
      if (std::abs(column[i]) > std::abs(column[pivot])) pivot = i;
    }
    pivots[j] = pivot;
    if (!(std::abs(column[pivot]) > 0.0)) return false;
    if (pivot != j) {
      for (int k = 0; k < m; ++k) std::swap(a[k * stride + j], a[k * stride + pivot]);
    }
    for (int i = j + 1; i < m; ++i) column[i] /= column[j];
    for (int k = j + 1; k < m; ++k) {
      double* other = a + k * stride;
      const double x = other[j];
      for (int i = j + 1; i < m; ++i) other[i] -= x * column[i];
    }
  }
  return true;
}

void lu_solve(const double* a, int m, int stride, const int* pivots, double* b) {
  for (int j = 0; j < m; ++j) std::swap(b[j], b[pivots[j]]);
  for (int j = 0; j < m; ++j) {
    const double* column = a + j * stride;
    for (int i = j + 1; i < m; ++i) b[i] -= b[j] * column[i];
  }
  for (int j = m - 1; j >= 0; --j) {
    const double* column = a + j * stride;
    b[j] /= column[j];
    for (int i = 0; i < j; ++i) b[i] -= b[j] * column[i];
  }
}

}  // namespace codesign::dynamics
