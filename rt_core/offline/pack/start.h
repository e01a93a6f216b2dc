#pragma once
#include "offline/track/track.h"
#include "online/model/state.h"

namespace railstep {

/// Guided wheelsets start with the speed of their guide (x and spin are free of forces).
void start_rolling(const Model& model, State& state);

/// Puts a state at step 0 into static equilibrium under the loads, wheelsets and weight, contact
/// included: each frictionless wheel carries what the balance of vertical force and roll gives it.
/// Velocities are those of the static shape moving along with loads and wheelsets, accelerations 0.
/// Throws std::invalid_argument if the track has a free rigid mode, if a wheelset would lift a
/// wheel, or if a force pushes a wheelset where nothing holds it (laterally).
void start_in_equilibrium(const Track& track, const Model& model, double gravity, State& state);

}  // namespace railstep
