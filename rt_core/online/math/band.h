#pragma once

#include <cstddef>
#include <cstdint>

#include "online/math/lanes.h"

namespace railstep {

/// Factors of a symmetric positive definite band matrix A = L D L', L unit lower in 8x8 blocks,
/// made by factor_band() (offline/pack/band_factor.h). Views only; n = 8 panels unknowns.
///
/// `forward` and `backward` are full panels. Columns that would lie before the first or after the
/// last unknown hold zeros and are never multiplied, so that no vector needs padding.
struct Band {
  std::int32_t panels;     // n / 8
  std::int32_t left;       // columns of L left of a panel, a multiple of 8
  const double* forward;   // [panels][left][8]  L(8p + lane, 8p - left + k)
  const double* inverse;   // [panels][8][8]     D_p^-1, column after column
  const double* backward;  // [panels][left][8]  L(8p + 8 + k, 8p + lane)
};

namespace band_detail {

/// x_p -= A[k][.] x[k] for k < width (a multiple of 8), for R right-hand sides.
///
/// Even and odd k are summed separately, then added: two chains hide the latency of additions. The
/// right-hand sides follow each other panel by panel, so that the last sums of one overlap with the
/// first of the next. Keeping all sums at once spills registers on g++ 12 and was slower.
template <int R>
inline void subtract_panel(const double* __restrict A, int width, const double* x, double* x_p,
                           std::ptrdiff_t stride) noexcept {
  for (int r = 0; r < R; ++r, x += stride, x_p += stride) {
    double even[kLanes] = {}, odd[kLanes] = {};
    for (int k = 0; k < width; k += 2) {
      const double* a = A + k * kLanes;
#pragma omp simd
      for (int l = 0; l < kLanes; ++l) even[l] += a[l] * x[k];
#pragma omp simd
      for (int l = 0; l < kLanes; ++l) odd[l] += a[kLanes + l] * x[k + 1];
    }
#pragma omp simd
    for (int l = 0; l < kLanes; ++l) x_p[l] -= even[l] + odd[l];
  }
}

/// x_p = D^-1 x_p, columns in order.
template <int R>
inline void multiply_block(const double* __restrict D, double* x_p,
                           std::ptrdiff_t stride) noexcept {
  for (int r = 0; r < R; ++r) {
    double* x = x_p + r * stride;
    double sum[kLanes] = {};
    for (int k = 0; k < kLanes; ++k) {
#pragma omp simd
      for (int l = 0; l < kLanes; ++l) sum[l] += D[k * kLanes + l] * x[k];
    }
    for (int l = 0; l < kLanes; ++l) x[l] = sum[l];
  }
}

}  // namespace band_detail

/// Panels [first, end) of a line's unknowns.
struct Panels {
  std::int32_t first, end;
};

// A x = b has three parts: L y = b, z = D^-1 y, L' x = z. Each takes R right-hand sides in place:
// x is [R] vectors of 8 panels entries, `stride` doubles apart. Every right-hand side gets the same
// bits as alone. Cannot fail: NaN in, NaN out.

/// Panel p of y = L^-1 b, after all from `first` on, before which b is 0.
template <int R>
inline void forward_panel(const Band& S, std::int32_t first, std::int32_t p, double* x,
                          std::ptrdiff_t stride) noexcept {
  // Columns before the first panel are skipped; x is addressed from the first real one.
  const int before = (p - first) * kLanes, width = before < S.left ? before : S.left;
  const std::ptrdiff_t panel = static_cast<std::ptrdiff_t>(S.left) * kLanes;
  band_detail::subtract_panel<R>(S.forward + p * panel + (S.left - width) * kLanes, width,
                                 x + (p * kLanes - width), x + p * kLanes, stride);
}

/// y = L^-1 b in the given panels, for a b that is 0 before them. Work: R * 16 left flops a panel.
template <int R>
inline void solve_forward(const Band& S, Panels at, double* x, std::ptrdiff_t stride) noexcept {
  for (std::int32_t p = at.first; p < at.end; ++p) forward_panel<R>(S, at.first, p, x, stride);
}

/// z = D^-1 y in the given panels. Work: R * 128 flops a panel.
template <int R>
inline void divide_by_pivots(const Band& S, Panels at, double* x, std::ptrdiff_t stride) noexcept {
  for (std::int32_t p = at.first; p < at.end; ++p)
    band_detail::multiply_block<R>(S.inverse + static_cast<std::ptrdiff_t>(p) * kLanes * kLanes,
                                   x + p * kLanes, stride);
}

/// x = L'^-1 z. Work: R * 16 left flops a panel.
template <int R>
inline void solve_backward(const Band& S, double* x, std::ptrdiff_t stride) noexcept {
  const std::ptrdiff_t panel = static_cast<std::ptrdiff_t>(S.left) * kLanes;
  const int n = S.panels * kLanes;
  for (int p = S.panels - 2; p >= 0; --p) {
    const int next = (p + 1) * kLanes;
    const int width = n - next < S.left ? n - next : S.left;
    band_detail::subtract_panel<R>(S.backward + p * panel, width, x + next, x + next - kLanes,
                                   stride);
  }
}

/// Solves A x = b in place for R right-hand sides at once. Work: R * panels * (32 left + 128)
/// flops.
template <int R>
inline void solve_band(const Band& S, double* x, std::ptrdiff_t stride) noexcept {
  static_assert(R >= 1 && R <= 4);
  solve_forward<R>(S, {0, S.panels}, x, stride);
  divide_by_pivots<R>(S, {0, S.panels}, x, stride);
  solve_backward<R>(S, x, stride);
}

/// x.y over panels. Lane k mod 8 adds its products in order, then lane_sum().
inline double panels_dot(Panels at, const double* x, const double* y) noexcept {
  double sum[kLanes] = {};
  for (std::int32_t p = at.first; p < at.end; ++p) {
#pragma omp simd
    for (int l = 0; l < kLanes; ++l) sum[l] += x[p * kLanes + l] * y[p * kLanes + l];
  }
  return lane_sum(sum);
}

/// y -= factor x in the panels of x.
inline void panels_subtract(Panels at, double factor, const double* x, double* y) noexcept {
#pragma omp simd
  for (std::int32_t k = at.first * kLanes; k < at.end * kLanes; ++k) y[k] -= factor * x[k];
}

constexpr Panels common(Panels a, Panels b) noexcept {
  return {a.first > b.first ? a.first : b.first, a.end < b.end ? a.end : b.end};
}

}  // namespace railstep
