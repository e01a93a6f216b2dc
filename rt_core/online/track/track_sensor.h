#pragma once
#include "online/model/state.h"

namespace railstep {

/// Values of the model's track sensors from a state and the outputs of its frame. They are left as
/// they are if the state is latched as not finite.
/// @param value  [model.track_sensor.count]
void read_track_sensors(const Model& model, const State& state, const Outputs& outputs,
                        double* value) noexcept;

}  // namespace railstep
