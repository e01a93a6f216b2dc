#pragma once
#include "online/model/state.h"

namespace railstep {

/// Frames of a model's self-check.
inline constexpr std::int32_t kCheckFrames = 8;

/// Inputs of every frame of a check: forces at a quarter of their limits, external wheels in the
/// middle of the track. @param input  [model.inputs] overwritten
void check_inputs(const Model& model, double* input) noexcept;

/// Steps a model from its start through the frames of its self-check.
/// @param state  overwritten by that of the last frame
/// @param row    [trace_columns()] of the last frame
void run_check(const Model& model, std::int32_t frames, State& state, Workspace& workspace,
               Outputs& outputs, double* row) noexcept;

/// Whether a model steps here to the same bits as where it was written: the state after its check
/// frames, and the published row. True for a model without a check. No heap.
/// @param state  at the start afterwards
/// @param row    [trace_columns()] scratch
[[nodiscard]] bool self_check(const Model& model, State& state, Workspace& workspace,
                              Outputs& outputs, double* row) noexcept;

}  // namespace railstep
