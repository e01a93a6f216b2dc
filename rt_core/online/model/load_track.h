#pragma once
#include "online/model/model.h"

namespace railstep {

/// Whether a track with what runs on it that was read from a block, its counts within their caps
/// and its arrays as long as they say, can be stepped: every index is of something there, every
/// mass, stiffness and compliance has the sign that makes the solve safe.
bool track_is_valid(const Model& model) noexcept;

/// Whether every input has a limit above 0.
bool inputs_are_valid(const Model& model) noexcept;

}  // namespace railstep
