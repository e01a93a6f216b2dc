#pragma once
#include "online/model/state.h"

namespace railstep {

/// Copies what frames publish of loads, wheels and flanges; what tells of the frame itself (status,
/// iterations, residuals) stays.
void copy_published(const Model& model, const Outputs& from, Outputs& to) noexcept;

}  // namespace railstep
