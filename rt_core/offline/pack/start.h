#pragma once
#include "offline/pack/pack.h"
#include "online/model/state.h"

namespace railstep {

/// The state at step 0 of a track at rest, unloaded: guided wheelsets have the speed of their guide
/// (x and spin are free of forces), vehicles touch their rail without a force in their springs, and
/// loads and weights act from then on.
std::vector<double> start_released(const PackedModel& packed);

/// The state at step 0 in static equilibrium under the loads, wheelsets, vehicles and weight,
/// contact included: each frictionless wheel of a wheelset carries what the balance of vertical
/// force and roll gives it. Velocities are those of the static shape moving along with loads and
/// wheels, accelerations 0.
/// @returns state_doubles() values
/// Throws std::invalid_argument if the track has a free rigid mode, if a wheelset or a vehicle
/// would lift a wheel, or if a force pushes a wheelset where nothing holds it (laterally).
std::vector<double> start_in_equilibrium(const Track& track, const PackedModel& packed,
                                         double gravity);

}  // namespace railstep
