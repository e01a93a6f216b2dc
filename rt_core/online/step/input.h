#pragma once
#include "online/model/state.h"

namespace railstep {

/// Takes a frame's inputs into the state. For an input that is not finite the last good value
/// stays; an input beyond its limit is cut to it.
/// @param value  [inputs] N or N m
/// @returns status bits of these events
Status take_inputs(const Model& model, const double* value, State& state) noexcept;

}  // namespace railstep
