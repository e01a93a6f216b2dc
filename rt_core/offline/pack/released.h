#pragma once
#include <vector>

#include "offline/pack/pack.h"

namespace railstep {

/// The state at step 0 of a track at rest, unloaded: guided wheelsets have the speed of their guide
/// (x and spin are free of forces), vehicles touch their rail without a force in their springs, and
/// loads and weights act from then on.
std::vector<double> start_released(const PackedModel& packed);

/// Lets the vehicles that fall be where they begin to, with the acceleration of free fall.
/// @param memory  of the model's state
void put_falling(const Model& model, const std::vector<RunningVehicle>& vehicles,
                 std::vector<double>& memory);

}  // namespace railstep
