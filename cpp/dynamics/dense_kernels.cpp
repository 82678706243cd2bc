#include "dynamics/dense_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>
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

// Of one column of C, `count` blocks of four rows (or of one, as a plain double) that start at
// `row`: + Σ_k f_k a_k, f_k = factor(k).
template <int count, class Rows, class Factor>
__attribute__((always_inline)) inline void add_columns(const double* a, const int* row, int m,
                                                       int a_stride, const Factor& factor,
                                                       Rows* sum) {
  Rows x, y, z;
  int k = 0;
  for (; k + 3 <= m; k += 3, a += 3 * a_stride) {
    const double f = factor(k), g = factor(k + 1), h = factor(k + 2);
    for (int b = 0; b < count; ++b) {
      load(a + row[b], x);
      load(a + a_stride + row[b], y);
      load(a + 2 * a_stride + row[b], z);
      sum[b] += f * x + g * y + h * z;
    }
  }
  for (; k < m; ++k, a += a_stride) {
    const double f = factor(k);
    for (int b = 0; b < count; ++b) {
      load(a + row[b], x);
      sum[b] += f * x;
    }
  }
}

// The same of a column j whose first j columns are factored: − Σ_k l_k a_k, k < j.
template <int count, class Rows>
__attribute__((always_inline)) inline void take_columns(const double* a, const int* row, int j,
                                                        int stride, Rows* sum) {
  Rows w, x, y, z;
  int k = 0;
  for (; k + 4 <= j; k += 4, a += 4 * stride) {
    const double* c1 = a + stride;
    const double* c2 = c1 + stride;
    const double* c3 = c2 + stride;
    for (int b = 0; b < count; ++b) {
      load(a + row[b], w);
      load(c1 + row[b], x);
      load(c2 + row[b], y);
      load(c3 + row[b], z);
      sum[b] -= (a[j] * w + c1[j] * x) + (c2[j] * y + c3[j] * z);
    }
  }
  for (; k < j; ++k, a += stride) {
    for (int b = 0; b < count; ++b) {
      load(a + row[b], w);
      sum[b] -= a[j] * w;
    }
  }
}

// Calls work(blocks, rows) for all rows from `first` to n of a column, at least four, in blocks of
// four that start at rows[0], rows[1], …: up to three blocks at a time, which share what they are
// multiplied with. The first block of the first call are the top rows; the others go up from the
// last row, so that one may overlap the top.
template <class Work>
__attribute__((always_inline)) inline void for_blocks(int first, int n, const Work& work) {
  int i = n - kRows;
  int rows[3] = {first, i, i - kRows};
  if (i <= first) return work(std::integral_constant<int, 1>(), rows);
  if (i - kRows <= first) return work(std::integral_constant<int, 2>(), rows);
  work(std::integral_constant<int, 3>(), rows);
  for (i -= 2 * kRows; i > first; i -= 3 * kRows) {
    for (int b = 0; b < 3; ++b) rows[b] = i - b * kRows;
    if (rows[1] <= first) return work(std::integral_constant<int, 1>(), rows);
    if (rows[2] <= first) return work(std::integral_constant<int, 2>(), rows);
    work(std::integral_constant<int, 3>(), rows);
  }
}

// Rows from `first` to n of a column of C, at least four: + Σ_k f_k a_k. The top rows are stored
// last: the block above them may have started from the same C.
template <class Factor>
__attribute__((always_inline)) inline void add_to_rows(const double* a, int first, int n, int m,
                                                       int a_stride, const Factor& factor,
                                                       double* c) {
  Four top = {0.0, 0.0, 0.0, 0.0};
  for_blocks(first, n, [&](auto count, const int* rows) {
    Four sum[count];
    for (int b = 0; b < count; ++b) load(c + rows[b], sum[b]);
    add_columns<count>(a, rows, m, a_stride, factor, sum);
    for (int b = 0; b < count; ++b) {
      if (rows[b] == first) {
        top = sum[b];
      } else {
        store(sum[b], c + rows[b]);
      }
    }
  });
  store(top, c + first);
}

// 1 / √pivot; zero if that is not a positive finite number.
inline double inverse_root(double pivot) {
  if (!(pivot > 0.0)) return 0.0;
  const double inverse = 1.0 / std::sqrt(pivot);
  return std::isfinite(inverse) ? inverse : 0.0;
}

}  // namespace

// Column by column. The last columns, shorter than four rows, go row by row.
CODESIGN_BOTH_WIDTHS
void add_outer_product(double* c, int n, int c_stride, const double* a, int m, int a_stride,
                       double factor) {
  for (int start = 0; start < m; start += kChunk, a += kChunk * a_stride) {
    const int chunk = std::min(kChunk, m - start);
    for (int j = 0; j < n; ++j) {
      const auto scaled = [=](int k) { return factor * a[k * a_stride + j]; };
      double* column = c + j * c_stride;
      if (j + kRows <= n) {
        add_to_rows(a, j, n, chunk, a_stride, scaled, column);
      } else {
        for (int i = j; i < n; ++i) add_columns<1>(a, &i, chunk, a_stride, scaled, column + i);
      }
    }
  }
}

void mirror(double* a, int n) {
  for (int j = 1; j < n; ++j) {
    double* column = a + j * n;
    const double* across = a + j;
    for (int i = 0; i < j; ++i, across += n) column[i] = *across;
  }
}

CODESIGN_BOTH_WIDTHS
void add_product(const double* a, int n, int m, int stride, const double* x, double* y) {
  const auto factor = [=](int k) { return x[k]; };
  if (n >= kRows) {
    add_to_rows(a, 0, n, m, stride, factor, y);
  } else {
    for (int i = 0; i < n; ++i) add_columns<1>(a, &i, m, stride, factor, y + i);
  }
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
    Four top = {0.0, 0.0, 0.0, 0.0};
    double inverse = 0.0;
    for_blocks(j, m, [&](auto count, const int* rows) {
      Four sum[count];
      for (int b = 0; b < count; ++b) load(column + rows[b], sum[b]);
      take_columns<count>(a, rows, j, stride, sum);
      if (rows[0] == j) inverse = inverse_root(sum[0][0]);
      for (int b = 0; b < count; ++b) {
        sum[b] *= inverse;
        if (rows[b] == j) {
          top = sum[b];
        } else {
          store(sum[b], column + rows[b]);
        }
      }
    });
    if (inverse == 0.0) return false;
    top[0] = inverse;
    store(top, column + j);
  }
  for (; j < m; ++j) {
    double* column = a + j * stride;
    for (int i = j; i < m; ++i) take_columns<1>(a, &i, j, stride, column + i);
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
