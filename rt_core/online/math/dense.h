#pragma once

namespace railstep {

/// Sum of x_i y_i, in order.
inline double dot(const double* x, const double* y, int n) noexcept {
  double sum = 0.;
  for (int i = 0; i < n; ++i) sum += x[i] * y[i];
  return sum;
}

/// y += A x, A of `count` columns [n], one after the other. Four columns at a time, so that y is
/// read and written less often.
inline void columns_multiply_add(const double* A, const double* x, double* y, int n,
                                 int count) noexcept {
  int j = 0;
  for (; j + 4 <= count; j += 4) {
    const double *a0 = A + j * n, *a1 = a0 + n, *a2 = a1 + n, *a3 = a2 + n;
    const double x0 = x[j], x1 = x[j + 1], x2 = x[j + 2], x3 = x[j + 3];
#pragma omp simd
    for (int i = 0; i < n; ++i)
      y[i] = (((y[i] + a0[i] * x0) + a1[i] * x1) + a2[i] * x2) + a3[i] * x3;
  }
  for (; j < count; ++j) {
    const double* const a = A + j * n;
    const double own = x[j];
#pragma omp simd
    for (int i = 0; i < n; ++i) y[i] += a[i] * own;
  }
}

/// y += A x, A [n][n] symmetric.
inline void symmetric_multiply_add(const double* A, const double* x, double* y, int n) noexcept {
  columns_multiply_add(A, x, y, n, n);
}

enum class SmallSolve : unsigned char {
  solved,
  indefinite,  // a pivot is not above 0
  not_finite,  // a pivot is not a number
};

/// Solves A x = b by LDL' without pivoting, A symmetric positive definite, n >= 0.
///
/// @param A  [n][n], upper triangle read; overwritten by L' above and 1/D on the diagonal
/// @param b  [n], b in, x out
/// Unless it returns `solved`, b is meaningless. Work: n^3 / 6 multiplications and as many
/// additions. Each row is subtracted from all behind it at once, so that no sum waits for itself.
[[nodiscard]] inline SmallSolve solve_small(double* A, double* b, int n) noexcept {
  for (int m = 0; m < n; ++m) {
    double* const row = A + m * n;
    if (!(row[m] > 0.0)) return row[m] <= 0.0 ? SmallSolve::indefinite : SmallSolve::not_finite;
    row[m] = 1.0 / row[m];
    for (int j = m + 1; j < n; ++j) {
      const double scaled = row[j] * row[m];
      double* const behind = A + j * n;
#pragma omp simd
      for (int k = j; k < n; ++k) behind[k] -= row[k] * scaled;
      row[j] = scaled;  // the rows behind j do not read it
      b[j] -= scaled * b[m];
    }
  }
  for (int j = 0; j < n; ++j) b[j] *= A[j * n + j];
  for (int j = n - 1; j >= 0; --j)
    for (int k = j + 1; k < n; ++k) b[j] -= A[j * n + k] * b[k];
  return SmallSolve::solved;
}

}  // namespace railstep
