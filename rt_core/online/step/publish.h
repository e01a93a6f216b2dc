#pragma once
#include "online/contact/couple.h"
#include "online/contact/external.h"
#include "online/model/progress.h"
#include "online/system/system_step.h"

namespace railstep {

// What a frame publishes. Of another file than the public calls, which set the floating-point mode:
// no arithmetic of it may leave that mode.

/// The state's displacements, as the lines read them.
inline Configuration standing(const Model& model, const State& s) noexcept {
  return {s.u, {s.u, s.v}, track_offset(model, s.steps)};
}

/// Before the first step of a frame.
void start_frame(const Model& model, const State& state, Outputs& outputs) noexcept;

/// Adds how a coupled solve went to the frame's outputs.
void collect_solve(const CoupleResult& met, Outputs& outputs) noexcept;

/// Adds what a step met to the frame's outputs.
void collect(const Model& model, const State& state, const CoupleResult& met,
             Outputs& outputs) noexcept;
void collect(const SystemResult& met, Outputs& outputs) noexcept;

/// Loads and health of a state as it stands, on what a frame has collected.
void publish(const Model& model, const State& state, Outputs& outputs) noexcept;

/// All of the outputs of a state from which no step was made.
void start_outputs(const Model& model, const State& state, Outputs& outputs) noexcept;

}  // namespace railstep
