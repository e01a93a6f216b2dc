#pragma once
#include "online/model/state.h"

namespace railstep {

/// If the traffic on a track without end passes a bay border on its way to a step, shifts the state
/// of the lines by a bay to the rear, and lets wheelsets count their way from the new border. Does
/// nothing otherwise. Uses workspace.scaled.
void shift_window(const Model& model, std::int64_t step, State& state,
                  Workspace& workspace) noexcept;

}  // namespace railstep
