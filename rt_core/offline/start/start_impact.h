#pragma once
#include "offline/pack/pack.h"

namespace railstep {

/// Start of a model whose track is unloaded and at rest when loads and weight suddenly act.
/// Three steps dt of backward Euler give velocities and accelerations; the acceleration of the
/// third step extrapolates them back to t = 0. Slow motions then start correctly to second order,
/// motions that dampers hold at rates far above 1 / dt have jumped to their velocity, and
/// vibrations within a step are left out, as they would ring.
///
/// If it starts from zero accelerations, a stiffly damped mass lags by half a step; if it starts
/// from F / m, generalised-alpha throws it back by half of F / k. Second order holds for motions of
/// at most 0.15 rad a step. For 0.15 to 1 rad a step the start from F / m errs by half as much.
///
/// For full order without one-sided springs; other models keep their start.
/// @returns state_doubles() values
std::vector<double> start_under_impact(const Track& track, const PackedModel& packed,
                                       double gravity);

}  // namespace railstep
