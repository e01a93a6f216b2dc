#pragma once

#include <cstddef>

#include "online/math/lanes.h"

namespace railstep {

/// y = A x for R right-hand sides; A in panels of 8 rows, column after column: [panels][n][8].
///
/// Each row adds its columns in order, starting from 0. x and y must not overlap.
/// @param x  [R] vectors of n entries, x_stride apart
/// @param y  [R] vectors of 8 panels entries, y_stride apart; overwritten
template <int R>
inline void panel_multiply(const double* __restrict A, const double* __restrict x,
                           std::ptrdiff_t x_stride, double* __restrict y, std::ptrdiff_t y_stride,
                           int panels, int n) noexcept {
  for (int p = 0; p < panels; ++p, y += kLanes) {
    double sum[R][kLanes] = {};
    for (int k = 0; k < n; ++k, A += kLanes)
      for (int r = 0; r < R; ++r) {
#pragma omp simd
        for (int l = 0; l < kLanes; ++l) sum[r][l] += A[l] * x[k + r * x_stride];
      }
    for (int r = 0; r < R; ++r)
      for (int l = 0; l < kLanes; ++l) y[l + r * y_stride] = sum[r][l];
  }
}

/// sum of x_i y_i: lane i mod 8 adds its products in order, then lane_sum().
inline double dot(const double* x, const double* y, int n) noexcept {
  double sum[kLanes] = {};
  int i = 0;
  for (; i + kLanes <= n; i += kLanes) {
#pragma omp simd
    for (int l = 0; l < kLanes; ++l) sum[l] += x[i + l] * y[i + l];
  }
  for (int l = 0; i < n; ++i, ++l) sum[l] += x[i] * y[i];
  return lane_sum(sum);
}

enum class SmallSolve : unsigned char {
  solved,
  indefinite,  // a pivot is not above 0
  not_finite,  // a pivot is not a number
};

/// Solves A x = b by LDL' without pivoting, A symmetric positive definite, n >= 0.
///
/// @param A  [n][n], lower triangle read; overwritten by L below and 1/D on the diagonal
/// @param b  [n], b in, x out
/// Unless it returns `solved`, b is meaningless. Work: n^3 / 3 multiplications and as many
/// additions.
[[nodiscard]] inline SmallSolve solve_small(double* A, double* b, int n) noexcept {
  for (int j = 0; j < n; ++j) {
    double* row = A + j * n;
    // Row j of L still times D; dividing it as the pivot is taken saves a pass.
    for (int k = 0; k < j; ++k)
      for (int m = 0; m < k; ++m) row[k] -= row[m] * A[k * n + m];
    for (int k = 0; k < j; ++k) {
      const double scaled = row[k] * A[k * n + k];
      row[j] -= row[k] * scaled;
      row[k] = scaled;
    }
    if (!(row[j] > 0.0)) return row[j] <= 0.0 ? SmallSolve::indefinite : SmallSolve::not_finite;
    row[j] = 1.0 / row[j];
  }
  for (int j = 0; j < n; ++j)
    for (int k = 0; k < j; ++k) b[j] -= A[j * n + k] * b[k];
  for (int j = 0; j < n; ++j) b[j] *= A[j * n + j];
  for (int j = n - 1; j >= 0; --j)
    for (int k = j + 1; k < n; ++k) b[j] -= A[k * n + j] * b[k];
  return SmallSolve::solved;
}

}  // namespace railstep
