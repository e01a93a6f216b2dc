#pragma once
#include <cstddef>

#include "online/model/state.h"

namespace railstep {

/// Largest stack that a frame needs in an optimised build, bytes.
inline constexpr std::size_t kStepStack = std::size_t{128} << 10;

/// Advances by one frame of model.steps_per_frame steps. No heap, no exceptions, no clock; the same
/// work for every state. Inputs keep the values in the state. A state that stops being finite is
/// reported and does not change any more. Outputs of loads and wheels then stay those of the last
/// good frame, which `outputs` must hold (publish_start() for the first). The caller may have any
/// floating-point rounding, flushing and trapping, which are restored.
/// @returns status of the frame, and the bits latched since the reset
[[nodiscard]] Status advance_frame(const Model& model, State& state, Workspace& workspace,
                                   Outputs& outputs) noexcept;

/// The same with new inputs, held over the frame's steps. For an input that is not finite the last
/// good value stays; an input beyond its limit is cut to it.
/// @param inputs  [model.inputs] N or N m
[[nodiscard]] Status advance_frame(const Model& model, const double* inputs, State& state,
                                   Workspace& workspace, Outputs& outputs) noexcept;

/// Response of the rail under external wheels in the next frame, so that a vehicle outside the
/// model can close its contacts in that frame. At its end the displacements of their points are, to
/// rounding,
///   free + compliance * forces,
/// with 3 n + d for direction d of wheel n. Beside other contacts this holds to first order in the
/// forces, and a step is tried for each force. The state is not changed. Places among the inputs
/// must be those of the frame; forces are not used.
/// @param free        [3 external_wheels] m; 0 off the rail
/// @param compliance  [3 external_wheels][3 external_wheels] m/N, symmetric; 0 off the rail
/// @returns status of the inputs and of the step without forces
[[nodiscard]] Status external_response(const Model& model, const double* inputs, const State& state,
                                       Workspace& workspace, double* free,
                                       double* compliance) noexcept;

/// Forces of loads and weight on the unknowns at a step, N; on modes of condensed lines, complex.
/// @param re, im  [unknowns] overwritten; im for condensed models only
/// @param before  s; the forces are those at this time before the step's end
void forces(const Model& model, std::int64_t step, double* re, double* im,
            double before = 0.) noexcept;

/// Outputs of a state from which no step was made: the first row of a trace. Wheels have the forces
/// at the start of the state.
void publish_start(const Model& model, const State& state, Outputs& outputs) noexcept;

}  // namespace railstep
