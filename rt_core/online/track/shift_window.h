#pragma once
#include "online/model/state.h"

namespace railstep {

/// On a track without end, where the traffic passes a bay border on its way to a step: what lines
/// hold is passed on by a bay to the rear, and wheelsets count their way from the new border.
/// Nothing elsewhere. Uses workspace.scaled.
void shift_window(const Model& model, std::int64_t step, State& state,
                  Workspace& workspace) noexcept;

}  // namespace railstep
