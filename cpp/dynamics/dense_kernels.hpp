#pragma once

// Dense kernels for the small symmetric matrices of one control step (orders 6 to 30), on raw
// column-major storage: column j starts at a + j·stride; of symmetric matrices only the lower
// triangle is read and written. Every sum has one order, whatever the machine and the width of its
// vectors, so the results are the same everywhere; at these sizes they beat a general library call.
namespace codesign::dynamics {

// Lower triangle of C += factor A Aᵀ; C is n×n, A is n×m.
void add_outer_product(double* c, int n, int c_stride, const double* a, int m, int a_stride,
                       double factor);

// Copies the lower triangle of the n×n matrix into the upper.
void mirror(double* a, int n);

// y += A x; A is n×m.
void add_product(const double* a, int n, int m, int stride, const double* x, double* y);

// y += Aᵀ x; A is n×m.
void add_transposed_product(const double* a, int n, int m, int stride, const double* x, double* y);

// Overwrites the lower triangle of the m×m matrix with L, A = L Lᵀ; the diagonal holds 1/L_jj.
// False, with the content lost, if a pivot is not positive (or not a number).
bool cholesky_in_place(double* a, int m, int stride);

// Overwrites b with the solution of A x = b, factor from cholesky_in_place.
void cholesky_solve(const double* a, int m, int stride, double* b);

// Overwrites the full m×m matrix with the factors of P A = L U, L with unit diagonal; row j was
// exchanged with row pivots[j]. False, with the content lost, if a pivot is zero or not a number.
bool lu_in_place(double* a, int m, int stride, int* pivots);

// Overwrites b with the solution of A x = b, factors from lu_in_place.
void lu_solve(const double* a, int m, int stride, const int* pivots, double* b);

}  // namespace codesign::dynamics
