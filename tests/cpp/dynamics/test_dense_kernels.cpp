#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "dynamics/dense_kernels.hpp"

namespace codesign::dynamics {
namespace {

using Eigen::MatrixXd;

// Sizes around the four rows and three or four columns that the kernels take at once, and the
// orders of a robot's matrices.
constexpr int kSizes[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 12, 13, 23, 27, 29, 47, 48, 49, 50};

MatrixXd random_matrix(std::mt19937_64& random, int rows, int cols) {
  return MatrixXd::NullaryExpr(rows, cols,
                               [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1.0; });
}

MatrixXd positive_definite(std::mt19937_64& random, int n) {
  const MatrixXd a = random_matrix(random, n, n);
  return a * a.transpose() + MatrixXd::Identity(n, n);
}

// C_ij in the order that the kernel promises: columns of A by three, in chunks of 48, the rest
// singly.
double outer_entry(const MatrixXd& C, const MatrixXd& A, double factor, int i, int j) {
  double sum = C(i, j);
  for (int start = 0; start < A.cols(); start += 48) {
    const int end = std::min<int>(start + 48, static_cast<int>(A.cols()));
    int k = start;
    for (; k + 3 <= end; k += 3) {
      sum += factor * A(j, k) * A(i, k) + factor * A(j, k + 1) * A(i, k + 1) +
             factor * A(j, k + 2) * A(i, k + 2);
    }
    for (; k < end; ++k) sum += factor * A(j, k) * A(i, k);
  }
  return sum;
}

// Column by column, four earlier columns at a time.
MatrixXd cholesky_in_order(MatrixXd a) {
  for (int j = 0; j < a.cols(); ++j) {
    for (int i = j; i < a.rows(); ++i) {
      int k = 0;
      for (; k + 4 <= j; k += 4) {
        a(i, j) -= (a(j, k) * a(i, k) + a(j, k + 1) * a(i, k + 1)) +
                   (a(j, k + 2) * a(i, k + 2) + a(j, k + 3) * a(i, k + 3));
      }
      for (; k < j; ++k) a(i, j) -= a(j, k) * a(i, k);
      if (i > j) continue;
      a(j, j) = 1.0 / std::sqrt(a(j, j));
    }
    for (int i = j + 1; i < a.rows(); ++i) a(i, j) *= a(j, j);
  }
  return a;
}

TEST(DenseKernels, ProductsSumInOneOrder) {
  std::mt19937_64 random(5);
  for (const int n : kSizes) {
    for (const int m : kSizes) {
      const MatrixXd A = random_matrix(random, n + 2, m);
      const MatrixXd x = random_matrix(random, m, 1), w = random_matrix(random, n, 1);
      MatrixXd y = random_matrix(random, n + 1, 1), z = random_matrix(random, m, 1);
      MatrixXd direct = y, transposed = z;
      for (int i = 0; i < n; ++i) {
        int k = 0;
        for (; k + 3 <= m; k += 3) {
          direct(i) += x(k) * A(i, k) + x(k + 1) * A(i, k + 1) + x(k + 2) * A(i, k + 2);
        }
        for (; k < m; ++k) direct(i) += x(k) * A(i, k);
      }
      for (int j = 0; j < m; ++j) {
        double sum[5] = {0.0, 0.0, 0.0, 0.0, 0.0};  // one for what four do not reach
        for (int i = 0; i < n; ++i) sum[i < n / 4 * 4 ? i % 4 : 4] += A(i, j) * w(i);
        transposed(j) += ((sum[0] + sum[2]) + (sum[1] + sum[3])) + sum[4];
      }
      add_product(A.data(), n, m, n + 2, x.data(), y.data());
      add_transposed_product(A.data(), n, m, n + 2, w.data(), z.data());
      ASSERT_EQ(y, direct) << n << " x " << m;
      ASSERT_EQ(z, transposed) << n << " x " << m;
    }
  }
}

TEST(DenseKernels, OuterProductSumsInOneOrderAndKeepsTheUpperTriangle) {
  std::mt19937_64 random(1);
  for (const int n : kSizes) {
    for (const int m : kSizes) {
      const MatrixXd A = random_matrix(random, n + 2, m), C = random_matrix(random, n + 1, n);
      MatrixXd sum = C;
      add_outer_product(sum.data(), n, n + 1, A.data(), m, n + 2, 0.7);
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i <= n; ++i) {
          const double expected = i < j || i == n ? C(i, j) : outer_entry(C, A, 0.7, i, j);
          ASSERT_EQ(sum(i, j), expected) << n << " x " << m << " at " << i << ", " << j;
        }
      }
    }
  }
}

TEST(DenseKernels, CholeskySumsInOneOrderAndKeepsTheUpperTriangle) {
  std::mt19937_64 random(2);
  for (const int n : kSizes) {
    const MatrixXd A = positive_definite(random, n);
    MatrixXd factor = A;
    ASSERT_TRUE(cholesky_in_place(factor.data(), n, n));
    const MatrixXd expected = cholesky_in_order(A);
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        ASSERT_EQ(factor(i, j), i < j ? A(i, j) : expected(i, j)) << n << " at " << i << ", " << j;
      }
    }
  }
}

TEST(DenseKernels, SolvesAgreeWithEigen) {
  std::mt19937_64 random(3);
  for (const int n : kSizes) {
    if (n == 0) continue;
    const MatrixXd A = positive_definite(random, n), B = random_matrix(random, n, n);
    const Eigen::VectorXd b = random_matrix(random, n, 1);
    MatrixXd factor = A;
    Eigen::VectorXd x = b;
    ASSERT_TRUE(cholesky_in_place(factor.data(), n, n));
    cholesky_solve(factor.data(), n, n, x.data());
    EXPECT_LE((A * x - b).norm(), 1e-13 * (A.norm() * x.norm())) << n;

    factor = B;
    x = b;
    Eigen::VectorXi pivots(n);
    ASSERT_TRUE(lu_in_place(factor.data(), n, n, pivots.data()));
    lu_solve(factor.data(), n, n, pivots.data(), x.data());
    EXPECT_LE((B * x - b).norm(), 1e-13 * n * (B.norm() * x.norm())) << n;
  }
}

TEST(DenseKernels, PivotsThatAreNotPositiveAreRefused) {
  std::mt19937_64 random(4);
  for (const int n : {1, 3, 4, 23}) {
    for (int row : {0, n / 2, n - 1}) {
      for (const double value : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::infinity()}) {
        MatrixXd A = positive_definite(random, n);
        A(row, row) = value;
        EXPECT_FALSE(cholesky_in_place(A.data(), n, n)) << n << " row " << row << ", " << value;
      }
    }
  }
}

}  // namespace
}  // namespace codesign::dynamics
