#pragma once
#include "online/model/system.h"

namespace railstep {

// A beam of a system by its kind: in space or in the plane.

inline void beam_forces(const BeamChainModel& b, const double* nodes, const double* half_change,
                        double* force) noexcept {
  if (b.planar != 0)
    planar_forces(b.chain.beam, b.chain.elements, nodes, half_change, force);
  else
    straight_forces(b.chain.beam, b.chain.elements, nodes, half_change, force);
}

inline void beam_tangents(const BeamChainModel& b, const double* nodes, const double* half_change,
                          double* force, double* tangents) noexcept {
  if (b.planar != 0)
    planar_tangents(b.chain.beam, b.chain.elements, nodes, half_change, force, tangents);
  else
    straight_tangents(b.chain.beam, b.chain.elements, nodes, half_change, force, tangents);
}

/// force += M g.
inline void beam_inertia(const BeamChainModel& b, const double* g, double* force) noexcept {
  b.planar != 0 ? chain_inertia<5>(b.chain, g, force) : chain_inertia<9>(b.chain, g, force);
}

inline int beam_factor(const BeamChainModel& b, double mass_factor, double k_factor,
                       double* tangents, double* factor) noexcept {
  return b.planar != 0 ? chain_factor<5>(b.chain, mass_factor, k_factor, tangents, factor)
                       : chain_factor<9>(b.chain, mass_factor, k_factor, tangents, factor);
}

inline void beam_solve(const BeamChainModel& b, const double* factor, double* x) noexcept {
  b.planar != 0 ? chain_solve<5>(b.chain, factor, x) : chain_solve<9>(b.chain, factor, x);
}

inline void beam_solve_one(const BeamChainModel& b, const double* factor, double* x) noexcept {
  b.planar != 0 ? chain_solve_one<5>(b.chain, factor, x) : chain_solve_one<9>(b.chain, factor, x);
}

inline std::int64_t beam_factor_doubles(const BeamChainModel& b) noexcept {
  return b.planar != 0 ? chain_factor_doubles<5>(b.chain.elements)
                       : chain_factor_doubles<9>(b.chain.elements);
}

inline std::int64_t beam_tangent_doubles(const BeamChainModel& b) noexcept {
  return b.planar != 0 ? chain_tangent_doubles<5>(b.chain.elements)
                       : chain_tangent_doubles<9>(b.chain.elements);
}

}  // namespace railstep
