#pragma once
#include "online/model/state.h"

namespace railstep {

/// Values of the model's track sensors on a state and the outputs that its frame published; left as
/// they are of a state that is latched as not finite.
/// @param value  [model.track_sensor.count]
void read_track_sensors(const Model& model, const State& state, const Outputs& outputs,
                        double* value) noexcept;

}  // namespace railstep
