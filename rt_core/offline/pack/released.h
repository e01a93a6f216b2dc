#pragma once
#include <vector>

#include "offline/pack/pack.h"

namespace railstep {

/// The state at step 0 of an unloaded track at rest. Guided wheelsets have the speed of their guide
/// (no force acts on x and spin), vehicles touch their rail without a force in their springs, and
/// loads and weights act from step 0 on.
std::vector<double> start_released(const PackedModel& packed);

/// Gives a rail vehicle that rolls freely its speed, and its wheels their spins.
void start_rolling(const RunnerModel& runner, State& state);

/// Puts falling vehicles at their height and speed, with the acceleration of free fall.
/// @param memory  of the model's state
void put_falling(const Model& model, const std::vector<RunningVehicle>& vehicles,
                 std::vector<double>& memory);

}  // namespace railstep
