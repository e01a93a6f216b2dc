#pragma once
#include "online/model/state.h"

namespace railstep {

/// Numbers in a row of a trace.
std::int32_t trace_columns(const Model& model) noexcept;

/// A row of a trace: time_s, then the columns of trace_columns.h. It is left as it is if the state
/// is latched as not finite.
/// @param outputs  published by the state's frame
/// @param row      [trace_columns()]
void trace_row(const Model& model, const State& state, const Outputs& outputs,
               double* row) noexcept;

}  // namespace railstep
