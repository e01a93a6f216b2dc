#pragma once
#include "online/model/system.h"

namespace railstep {

// A beam of a system by its kind: in space or in the plane.

/// @param held  of the beam; null where none is asked for
inline Chain chain_of(const BeamChainModel& b, const std::int32_t* held = nullptr) noexcept {
  return {b.element, {b.mass[0], b.mass[1], b.mass[2], b.mass[3]}, held, b.held, b.elements};
}

inline void beam_forces(const BeamChainModel& b, const double* nodes, const double* half_change,
                        double* force) noexcept {
  if (b.planar != 0)
    planar_forces(b.element, b.elements, nodes, half_change, force);
  else
    straight_forces(b.element, b.elements, nodes, half_change, force);
}

inline void beam_tangents(const BeamChainModel& b, const double* nodes, const double* half_change,
                          double* force, double* tangents) noexcept {
  if (b.planar != 0)
    planar_tangents(b.element, b.elements, nodes, half_change, force, tangents);
  else
    straight_tangents(b.element, b.elements, nodes, half_change, force, tangents);
}

/// force += M g.
inline void beam_inertia(const BeamChainModel& b, const double* g, double* force) noexcept {
  const Chain chain = chain_of(b);
  b.planar != 0 ? chain_inertia<5>(chain, g, force) : chain_inertia<9>(chain, g, force);
}

inline int beam_factor(const SystemModel& s, const BeamChainModel& b, double mass_factor,
                       double k_factor, double* tangents, double* factor) noexcept {
  const Chain chain = chain_of(b, s.held_unknown + b.first_held);
  return b.planar != 0 ? chain_factor<5>(chain, mass_factor, k_factor, tangents, factor)
                       : chain_factor<9>(chain, mass_factor, k_factor, tangents, factor);
}

inline void beam_solve(const SystemModel& s, const BeamChainModel& b, const double* factor,
                       double* x) noexcept {
  const Chain chain = chain_of(b, s.held_unknown + b.first_held);
  b.planar != 0 ? chain_solve<5>(chain, factor, x) : chain_solve<9>(chain, factor, x);
}

inline void beam_solve_one(const SystemModel& s, const BeamChainModel& b, const double* factor,
                           double* x) noexcept {
  const Chain chain = chain_of(b, s.held_unknown + b.first_held);
  b.planar != 0 ? chain_solve_one<5>(chain, factor, x) : chain_solve_one<9>(chain, factor, x);
}

inline std::int64_t beam_factor_doubles(const BeamChainModel& b) noexcept {
  return b.planar != 0 ? chain_factor_doubles<5>(b.elements) : chain_factor_doubles<9>(b.elements);
}

inline std::int64_t beam_tangent_doubles(const BeamChainModel& b) noexcept {
  return b.planar != 0 ? chain_tangent_doubles<5>(b.elements)
                       : chain_tangent_doubles<9>(b.elements);
}

}  // namespace railstep
