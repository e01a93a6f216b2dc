#pragma once
#include "online/model/state.h"

namespace railstep {

/// Writes displacements and forces of a runner's linear elements that are published. On a design
/// line they follow the poses of frames in first order.
/// @param poses  of poses_of()
void publish_traced(const Model& model, const RunnerModel& runner, const State& at,
                    const double* poses, Outputs& outputs) noexcept;

}  // namespace railstep
