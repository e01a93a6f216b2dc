#pragma once
#include <cstddef>

#include "online/model/state.h"

namespace railstep {

/// What a frame may need of the caller's stack, bytes, in an optimised build.
inline constexpr std::size_t kStepStack = std::size_t{128} << 10;

/// Advances by one frame of model.steps_per_frame steps. No heap, no exceptions, no clock; the
/// same work for every state. Inputs stay as the state holds them. A state that stops being finite
/// is reported and left as it is from then on, and what is published of loads and wheels stays that
/// of the last good frame, which `outputs` must hold (publish_start() for the first). The caller's
/// rounding, flushing and trapping of floating-point numbers may be anything, and stay.
/// @returns what the frame met, and what is latched since the reset
[[nodiscard]] Status advance_frame(const Model& model, State& state, Workspace& workspace,
                                   Outputs& outputs) noexcept;

/// The same with new inputs, held over the frame's steps; of one that is not finite the last good
/// one goes on, and one beyond its limit is cut to it.
/// @param inputs  [model.inputs] N or N m
[[nodiscard]] Status advance_frame(const Model& model, const double* inputs, State& state,
                                   Workspace& workspace, Outputs& outputs) noexcept;

/// What the next frame makes of the rail under external wheels, so that a vehicle outside the model
/// can close its contacts in that frame: at its end their points are displaced, to rounding, by
///   free + compliance * forces,
/// with 3 n + d for direction d of wheel n. The state is not changed. Forces among the inputs are
/// not looked at, places must be those of the frame.
/// @param free        [3 external_wheels] m; 0 off the rail
/// @param compliance  [3 external_wheels][3 external_wheels] m/N, symmetric; 0 off the rail
/// @returns what the inputs and the step without forces met
[[nodiscard]] Status external_response(const Model& model, const double* inputs, const State& state,
                                       Workspace& workspace, double* free,
                                       double* compliance) noexcept;

/// Forces of loads and weight on the unknowns at a step, N; on modes of condensed lines, complex.
/// @param re, im  [unknowns] overwritten; im of condensed models only
/// @param before  s, by how much they are those ahead of the step
void forces(const Model& model, std::int64_t step, double* re, double* im,
            double before = 0.) noexcept;

/// Outputs of a state from which no step was made: the first row of a trace. Wheels carry the
/// forces that the state starts with.
void publish_start(const Model& model, const State& state, Outputs& outputs) noexcept;

}  // namespace railstep
