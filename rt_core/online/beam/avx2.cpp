// The kernels of rows once more, in vectors of four. AVX2 has no fused products, so the bits are
// those of the base.
//
// Headers that other sources share are included before the instruction set is changed: a linker may
// take their functions from here for the whole program, which must run on every processor
// (tests/checks/check-kernels).
#include <utility>

#include "online/beam/kernels.h"

#ifdef RAILSTEP_HAS_AVX2_KERNELS
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC target("avx2")
#endif
#define RAILSTEP_AVX2_KERNELS
// NOLINTBEGIN(bugprone-suspicious-include): sources, on purpose
#include "online/beam/chain.cpp"
#include "online/beam/chain_solve.cpp"
#include "online/beam/straight_rows.cpp"
// NOLINTEND(bugprone-suspicious-include)

namespace railstep {

const Kernels kAvx2Kernels{"avx2",
                           {avx2::straight_forces, avx2::straight_tangents, avx2::chain_inertia<9>,
                            avx2::chain_factor<9>, avx2::chain_solve<9>, avx2::chain_solve_one<9>},
                           {avx2::planar_forces, avx2::planar_tangents, avx2::chain_inertia<5>,
                            avx2::chain_factor<5>, avx2::chain_solve<5>, avx2::chain_solve_one<5>}};

}  // namespace railstep
#if defined(__clang__)
#pragma clang attribute pop
#endif
#endif
