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

/// x_p -= A[k][.] x[k] for k < width (a multiple of 8).
///
/// Even and odd k are summed separately, then added: two chains hide the latency of additions.
inline void subtract_panel(const double* __restrict A, int width, const double* x,
                           double* x_p) noexcept {
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

/// x = D^-1 x, columns in order.
inline void multiply_block(const double* __restrict D, double* x) noexcept {
  double sum[kLanes] = {};
  for (int k = 0; k < kLanes; ++k) {
#pragma omp simd
    for (int l = 0; l < kLanes; ++l) sum[l] += D[k * kLanes + l] * x[k];
  }
  for (int l = 0; l < kLanes; ++l) x[l] = sum[l];
}

}  // namespace band_detail

/// Panels [first, end) of a line's unknowns.
struct Panels {
  std::int32_t first, end;
};

// A x = b has three parts: L y = b, z = D^-1 y, L' x = z. Each works in place on the vector x of 8
// panels entries. Cannot fail: NaN in, NaN out.

/// Panel p of y = L^-1 b, after all from `first` on, before which b is 0.
inline void forward_panel(const Band& S, std::int32_t first, std::int32_t p, double* x) noexcept {
  // Columns before the first panel are skipped; x is addressed from the first real one.
  const int before = (p - first) * kLanes, width = before < S.left ? before : S.left;
  const std::ptrdiff_t panel = static_cast<std::ptrdiff_t>(S.left) * kLanes;
  band_detail::subtract_panel(S.forward + p * panel + (S.left - width) * kLanes, width,
                              x + (p * kLanes - width), x + p * kLanes);
}

/// y = L^-1 b in the given panels, for a b that is 0 before them. Work: 16 left flops a panel.
inline void solve_forward(const Band& S, Panels at, double* x) noexcept {
  for (std::int32_t p = at.first; p < at.end; ++p) forward_panel(S, at.first, p, x);
}

/// z = D^-1 y in the given panels. Work: 128 flops a panel.
inline void divide_by_pivots(const Band& S, Panels at, double* x) noexcept {
  for (std::int32_t p = at.first; p < at.end; ++p)
    band_detail::multiply_block(S.inverse + static_cast<std::ptrdiff_t>(p) * kLanes * kLanes,
                                x + p * kLanes);
}

/// x = L'^-1 z. Work: 16 left flops a panel.
inline void solve_backward(const Band& S, double* x) noexcept {
  const std::ptrdiff_t panel = static_cast<std::ptrdiff_t>(S.left) * kLanes;
  const int n = S.panels * kLanes;
  for (int p = S.panels - 2; p >= 0; --p) {
    const int next = (p + 1) * kLanes;
    const int width = n - next < S.left ? n - next : S.left;
    band_detail::subtract_panel(S.backward + p * panel, width, x + next, x + next - kLanes);
  }
}

/// Solves A x = b in place. Work: panels * (32 left + 128) flops.
inline void solve_band(const Band& S, double* x) noexcept {
  solve_forward(S, {0, S.panels}, x);
  divide_by_pivots(S, {0, S.panels}, x);
  solve_backward(S, x);
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
