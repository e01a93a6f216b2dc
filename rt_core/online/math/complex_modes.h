#pragma once

#include "online/math/lanes.h"

namespace railstep {

/// A complex vector as two real ones. Its length n is always a multiple of 8.
struct Complex {
  const double* re;
  const double* im;
};

/// Re sum a_k z_k, the displacement of a point of complex shape a by modes z. Lane k mod 8 adds its
/// products in order, then lane_sum().
inline double modes_dot(Complex a, Complex z, int n) noexcept {
  double sum[kLanes] = {};
  for (int k = 0; k < n; k += kLanes) {
#pragma omp simd
    for (int l = 0; l < kLanes; ++l)
      sum[l] += a.re[k + l] * z.re[k + l] - a.im[k + l] * z.im[k + l];
  }
  return lane_sum(sum);
}

/// y += factor a.
inline void modes_add(double factor, Complex a, double* __restrict re, double* __restrict im,
                      int n) noexcept {
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    re[k] += factor * a.re[k];
    im[k] += factor * a.im[k];
  }
}

/// y = a b, entry by entry; y must not overlap with a or b.
inline void modes_multiply(Complex a, Complex b, double* __restrict re, double* __restrict im,
                           int n) noexcept {
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    re[k] = a.re[k] * b.re[k] - a.im[k] * b.im[k];
    im[k] = a.re[k] * b.im[k] + a.im[k] * b.re[k];
  }
}

}  // namespace railstep
