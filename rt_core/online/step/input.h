#pragma once
#include "online/model/state.h"

namespace railstep {

/// Takes a frame's inputs into the state: one that is not finite leaves the last good one, one
/// beyond its limit is cut to it.
/// @param value  [inputs] N or N m
/// @returns what was met
Status take_inputs(const Model& model, const double* value, State& state) noexcept;

}  // namespace railstep
