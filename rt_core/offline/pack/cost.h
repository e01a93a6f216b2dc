#pragma once
#include <cstdint>

#include "online/model/model.h"

namespace railstep {

/// Bound of the floating-point additions and multiplications of one frame, loads and contacts at
/// their caps included; probes are read between frames and stand beside.
std::int64_t flops_per_frame(const Model& model);

}  // namespace railstep
