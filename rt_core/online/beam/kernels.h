#pragma once
#include "online/beam/chain.h"

namespace railstep {

/// The calls for a row of elements: of straight.h or planar.h, and of chain.h.
struct RowKernels {
  decltype(&straight_forces) forces;
  decltype(&straight_tangents) tangents;
  decltype(&chain_inertia<9>) inertia;
  decltype(&chain_factor<9>) factor;
  decltype(&chain_solve<9>) solve;
  decltype(&chain_solve_one<9>) solve_one;
};

/// A set of them, compiled for the vectors that some processors have. All sets give the same bits.
struct Kernels {
  const char* name;
  RowKernels space, plane;
};

/// Those functions themselves: for every processor that the library is built for.
extern const Kernels kBaseKernels;

// Functions in vectors of four, for processors that have AVX2. They do not exist if the whole
// library is built for such vectors, or if RAILSTEP_NO_AVX2 is defined.
#if defined(__x86_64__) && !defined(__AVX__) && !defined(RAILSTEP_NO_AVX2)
#define RAILSTEP_HAS_AVX2_KERNELS
extern const Kernels kAvx2Kernels;
#endif

/// The set that beams are stepped with: the quickest for the processor, or the one that was asked
/// for.
const Kernels& kernels_in_use() noexcept;

/// Asks for a set, for all models from now on; null: the quickest for the processor. For
/// comparisons, and not while another thread steps.
void use_kernels(const Kernels* set) noexcept;

}  // namespace railstep
