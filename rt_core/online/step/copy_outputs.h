#pragma once
#include "online/model/state.h"

namespace railstep {

/// Copies the published outputs of loads, wheels and flanges; those of the frame itself (status,
/// iterations, residuals) are left.
void copy_published(const Model& model, const Outputs& from, Outputs& to) noexcept;

}  // namespace railstep
