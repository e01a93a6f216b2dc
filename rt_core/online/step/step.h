#pragma once
#include "online/model/state.h"

namespace railstep {

/// Advances by one frame of model.steps_per_frame steps. No heap, no exceptions, no clock; the
/// same work for every state. A state that stops being finite is reported and left as it is. The
/// caller's rounding, flushing and trapping of floating-point numbers may be anything, and stay.
[[nodiscard]] Status advance_frame(const Model& model, State& state, Workspace& workspace,
                                   Outputs& outputs) noexcept;

/// Forces of loads and weight on the unknowns at a step, N; on modes of condensed lines, complex.
/// @param re, im  [unknowns] overwritten; im of condensed models only
void forces(const Model& model, std::int64_t step, double* re, double* im) noexcept;

/// Outputs of a state from which no step was made: the first row of a trace. Wheels carry the
/// forces that the state starts with.
void publish_start(const Model& model, const State& state, Outputs& outputs) noexcept;

}  // namespace railstep
