#include "online/beam/kernels.h"

namespace railstep {

const Kernels kBaseKernels{"base",
                           {straight_forces, straight_tangents, chain_inertia<9>, chain_factor<9>,
                            chain_solve<9>, chain_solve_one<9>},
                           {planar_forces, planar_tangents, chain_inertia<5>, chain_factor<5>,
                            chain_solve<5>, chain_solve_one<5>}};

namespace {

const Kernels* asked_for = nullptr;

}  // namespace

const Kernels& kernels_in_use() noexcept {
  if (asked_for != nullptr) return *asked_for;
#ifdef RAILSTEP_HAS_AVX2_KERNELS
  if (__builtin_cpu_supports("avx2")) return kAvx2Kernels;
#endif
  return kBaseKernels;
}

void use_kernels(const Kernels* set) noexcept { asked_for = set; }

}  // namespace railstep
