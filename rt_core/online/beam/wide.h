#pragma once

// Rows of elements are compiled for the vectors that every processor has, and on x86-64 once more
// for vectors of four (avx2.cpp). Each set has a namespace of its own, so that no linker takes a
// function of one for the other.
#ifdef RAILSTEP_AVX2_KERNELS
#define RAILSTEP_KERNELS railstep::avx2
#else
#define RAILSTEP_KERNELS railstep
#endif
#if defined(__AVX__) || defined(RAILSTEP_AVX2_KERNELS)
#define RAILSTEP_WIDE 4
#else
#define RAILSTEP_WIDE 2
#endif

namespace RAILSTEP_KERNELS {

// Vectors of the compiler's own, for speed alone: each lane is rounded as a double by itself.
using Two = double __attribute__((vector_size(16)));
inline constexpr int kWide = RAILSTEP_WIDE;
using Wide = double __attribute__((vector_size(kWide * sizeof(double))));

[[gnu::always_inline]] inline Wide load(const double* from) noexcept {
  Wide x;
  __builtin_memcpy(&x, from, sizeof x);
  return x;
}
[[gnu::always_inline]] inline void store(const Wide& x, double* to) noexcept {
  __builtin_memcpy(to, &x, sizeof x);
}

/// Rows become columns, [kWide][kWide].
[[gnu::always_inline]] inline void transpose(Wide* x) noexcept {
#if RAILSTEP_WIDE == 4
  const Wide a = __builtin_shufflevector(x[0], x[1], 0, 4, 2, 6);
  const Wide b = __builtin_shufflevector(x[0], x[1], 1, 5, 3, 7);
  const Wide c = __builtin_shufflevector(x[2], x[3], 0, 4, 2, 6);
  const Wide d = __builtin_shufflevector(x[2], x[3], 1, 5, 3, 7);
  x[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  x[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  x[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  x[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
#else
  const Wide a = __builtin_shufflevector(x[0], x[1], 0, 2);
  x[1] = __builtin_shufflevector(x[0], x[1], 1, 3);
  x[0] = a;
#endif
}

}  // namespace RAILSTEP_KERNELS
