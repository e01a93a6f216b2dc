#pragma once
#include "online/model/model.h"

namespace railstep {

/// Whether a track and its traffic that were read from a block can be stepped: every index is in
/// range, and every mass, stiffness and compliance has the sign that makes the solve safe. Counts
/// must be within their caps, and arrays as long as the counts say.
bool track_is_valid(const Model& model) noexcept;

/// Whether every input has a limit above 0.
bool inputs_are_valid(const Model& model) noexcept;

}  // namespace railstep
