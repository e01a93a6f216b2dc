#pragma once
#include "online/contact/couple.h"
#include "online/contact/external.h"
#include "online/model/progress.h"
#include "online/system/system_step.h"

namespace railstep {

// The outputs of a frame. In another file than the public calls, which set the floating-point mode:
// none of this arithmetic may move out of that mode.

/// The state's displacements for the lines.
inline Configuration standing(const Model& model, const State& s) noexcept {
  return {s.u, {s.u, s.v}, track_offset(model, s.steps)};
}

/// Prepares the outputs before the first step of a frame.
void start_frame(const Model& model, const State& state, Outputs& outputs) noexcept;

/// Adds the results of a coupled solve to the frame's outputs.
void collect_solve(const CoupleResult& met, Outputs& outputs) noexcept;

/// Adds the results of a step to the frame's outputs.
void collect(const Model& model, const State& state, const CoupleResult& met,
             Outputs& outputs) noexcept;
void collect(const SystemResult& met, Outputs& outputs) noexcept;

/// Publishes loads and checks of the present state, on top of the collected results.
void publish(const Model& model, const State& state, Outputs& outputs) noexcept;

/// Sets all outputs of a state from which no step was made.
void start_outputs(const Model& model, const State& state, Outputs& outputs) noexcept;

}  // namespace railstep
