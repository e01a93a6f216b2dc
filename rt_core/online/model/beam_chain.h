#pragma once
#include "online/beam/kernels.h"
#include "online/model/system.h"

namespace railstep {

// A beam of a system, in space or in the plane.

/// @param held  of the beam; null if they are not needed
inline Chain chain_of(const BeamChainModel& b, const std::int32_t* held = nullptr) noexcept {
  return {b.element, {b.mass[0], b.mass[1], b.mass[2], b.mass[3]}, held, b.held, b.elements};
}

inline const RowKernels& row_kernels(const BeamChainModel& b) noexcept {
  return b.planar != 0 ? kernels_in_use().plane : kernels_in_use().space;
}

inline void beam_forces(const BeamChainModel& b, const double* nodes, const double* half_change,
                        double* force) noexcept {
  row_kernels(b).forces(b.element, b.elements, nodes, half_change, force);
}

inline void beam_tangents(const BeamChainModel& b, const double* nodes, const double* half_change,
                          double* force, double* tangents) noexcept {
  row_kernels(b).tangents(b.element, b.elements, nodes, half_change, force, tangents);
}

/// force += M g.
inline void beam_inertia(const BeamChainModel& b, const double* g, double* force) noexcept {
  row_kernels(b).inertia(chain_of(b), g, force);
}

inline int beam_factor(const SystemModel& s, const BeamChainModel& b, double mass_factor,
                       double k_factor, double* tangents, double* factor) noexcept {
  const Chain chain = chain_of(b, s.held_unknown + b.first_held);
  return row_kernels(b).factor(chain, mass_factor, k_factor, tangents, factor);
}

inline void beam_solve(const SystemModel& s, const BeamChainModel& b, const double* factor,
                       double* x) noexcept {
  row_kernels(b).solve(chain_of(b, s.held_unknown + b.first_held), factor, x);
}

inline void beam_solve_one(const SystemModel& s, const BeamChainModel& b, const double* factor,
                           double* x) noexcept {
  row_kernels(b).solve_one(chain_of(b, s.held_unknown + b.first_held), factor, x);
}

inline std::int64_t beam_factor_doubles(const BeamChainModel& b) noexcept {
  return b.planar != 0 ? chain_factor_doubles<5>(b.elements) : chain_factor_doubles<9>(b.elements);
}

inline std::int64_t beam_tangent_doubles(const BeamChainModel& b) noexcept {
  return b.planar != 0 ? chain_tangent_doubles<5>(b.elements)
                       : chain_tangent_doubles<9>(b.elements);
}

}  // namespace railstep
