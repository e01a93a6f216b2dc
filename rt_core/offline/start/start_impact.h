#pragma once
#include "offline/pack/pack.h"

namespace railstep {

/// The start that a model has, of an unloaded track at rest that loads and weight strike at once.
/// Velocities and accelerations are what three steps dt of backward Euler come to, drawn back to
/// t = 0 by the acceleration of the third: what is slow starts as it should to the second order,
/// what dampers hold at rates far above 1 / dt has jumped to its velocity, and what swings within a
/// step is left out, as it would ring.
///
/// From zero accelerations a stiffly damped mass lags by half a step; from F / m generalised-alpha
/// is thrown back by half of F / k. Second order means steps of 0.15 rad and less of a motion: of
/// one that turns by more a step, up to 1 rad, the start from F / m errs by half as much.
///
/// For full order without one-sided springs; others are left as they are.
/// @returns state_doubles() values
std::vector<double> start_under_impact(const Track& track, const PackedModel& packed,
                                       double gravity);

}  // namespace railstep
