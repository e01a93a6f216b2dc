#pragma once
#include "online/model/model.h"

namespace railstep {

/// Whether a system that was read from a block, its counts within their caps and its arrays as long
/// as they say, can be stepped: every index is of something there, every part has its own unknowns
/// and a mass, every loop an end.
bool system_is_valid(const Model& model) noexcept;

/// Whether the bodies of a system that holds start with rotations.
bool system_start_is_valid(const Model& model) noexcept;

}  // namespace railstep
