#pragma once

#include <cmath>
#include <utility>

// Dense kernels for the small symmetric matrices of one control step (orders 6 to 30), on raw
// column-major storage: column j starts at a + j·stride; of symmetric matrices only the lower
// triangle is read and written. Plain loops over contiguous columns, which the compiler vectorizes
// without reordering a sum; at these sizes they beat a general library call.
namespace codesign::dynamics {

// Lower triangle of C += factor A Aᵀ; C is n×n, A is n×m.
inline void add_outer_product(double* c, int n, int c_stride, const double* a, int m, int a_stride,
                              double factor) {
  for (int j = 0; j < n; ++j) {
    double* column = c + j * c_stride;
    int k = 0;
    for (; k + 3 <= m; k += 3) {
      const double* a0 = a + k * a_stride;
      const double* a1 = a0 + a_stride;
      const double* a2 = a1 + a_stride;
      const double f0 = factor * a0[j], f1 = factor * a1[j], f2 = factor * a2[j];
      for (int i = j; i < n; ++i) column[i] += f0 * a0[i] + f1 * a1[i] + f2 * a2[i];
    }
    for (; k < m; ++k) {
      const double* a0 = a + k * a_stride;
      const double f0 = factor * a0[j];
      for (int i = j; i < n; ++i) column[i] += f0 * a0[i];
    }
  }
}

// Overwrites the lower triangle of the m×m matrix with L, A = L Lᵀ; the diagonal holds 1/L_jj.
// False, with the content lost, if a pivot is not positive (or not a number).
inline bool cholesky_in_place(double* a, int m, int stride) {
  for (int j = 0; j < m; ++j) {
    double* column = a + j * stride;
    int k = 0;
    for (; k + 4 <= j; k += 4) {
      const double* c0 = a + k * stride;
      const double* c1 = c0 + stride;
      const double* c2 = c1 + stride;
      const double* c3 = c2 + stride;
      const double l0 = c0[j], l1 = c1[j], l2 = c2[j], l3 = c3[j];
      for (int i = j; i < m; ++i) {
        column[i] -= (l0 * c0[i] + l1 * c1[i]) + (l2 * c2[i] + l3 * c3[i]);
      }
    }
    for (; k < j; ++k) {
      const double* c = a + k * stride;
      const double l = c[j];
      for (int i = j; i < m; ++i) column[i] -= l * c[i];
    }
    const double pivot = column[j];
    if (!(pivot > 0.0)) return false;
    const double inverse_root = 1.0 / std::sqrt(pivot);
    if (!std::isfinite(inverse_root)) return false;
    for (int i = j + 1; i < m; ++i) column[i] *= inverse_root;
    column[j] = inverse_root;
  }
  return true;
}

// Overwrites b with L⁻¹ b, L from cholesky_in_place.
inline void cholesky_forward(const double* a, int m, int stride, double* b) {
  for (int j = 0; j < m; ++j) {
    const double* column = a + j * stride;
    const double x = b[j] * column[j];
    b[j] = x;
    for (int i = j + 1; i < m; ++i) b[i] -= x * column[i];
  }
}

// Overwrites b with the solution of A x = b.
inline void cholesky_solve(const double* a, int m, int stride, double* b) {
  cholesky_forward(a, m, stride, b);
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

// Overwrites the full m×m matrix with the factors of P A = L U, L with unit diagonal; row j was
// exchanged with row pivots[j]. False, with the content lost, if a pivot is zero or not a number.
inline bool lu_in_place(double* a, int m, int stride, int* pivots) {
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

// Overwrites b with the solution of A x = b, factors from lu_in_place.
inline void lu_solve(const double* a, int m, int stride, const int* pivots, double* b) {
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
