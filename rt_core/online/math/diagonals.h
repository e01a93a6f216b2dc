#pragma once

#include <cstddef>
#include <cstdint>

#include "online/math/lanes.h"

namespace railstep {

/// A square matrix stored by diagonals: A(i, i + offset[o]) = value[o * n + i]. Views only.
struct Diagonals {
  std::int32_t n;              // unknowns, a multiple of 8
  std::int32_t count;          // of diagonals
  const std::int32_t* offset;  // [count], in the order in which they are summed
  const double* value;  // [count][n]; entries whose column is outside the matrix are not read
};

/// y += A x: row i adds value_o[i] x[i + offset_o] to y[i], o in order. x and y must not overlap.
inline void diagonals_multiply_add(const Diagonals& A, const double* __restrict x,
                                   double* __restrict y) noexcept {
  for (int i = 0; i < A.n; i += kLanes) {
    double sum[kLanes];
    for (int l = 0; l < kLanes; ++l) sum[l] = y[i + l];
    for (int o = 0; o < A.count; ++o) {
      const double* a = A.value + static_cast<std::ptrdiff_t>(o) * A.n + i;
      const int at = i + A.offset[o];
      if (at >= 0 && at + kLanes <= A.n) {
#pragma omp simd
        for (int l = 0; l < kLanes; ++l) sum[l] += a[l] * x[at + l];
      } else {
        for (int l = 0; l < kLanes; ++l)
          if (at + l >= 0 && at + l < A.n) sum[l] += a[l] * x[at + l];
      }
    }
    for (int l = 0; l < kLanes; ++l) y[i + l] = sum[l];
  }
}

}  // namespace railstep
