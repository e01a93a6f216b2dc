#pragma once
#include "online/model/model.h"

namespace railstep {

/// Whether a system that was read from a block can be stepped: every index is in range, every part
/// has its own unknowns and a mass, every loop ends. Counts must be within their caps, and arrays
/// as long as the counts say.
bool system_is_valid(const Model& model) noexcept;

/// Whether the quaternions of the bodies at the start are rotations. The system must be valid.
bool system_start_is_valid(const Model& model) noexcept;

}  // namespace railstep
