#pragma once
#include "online/model/model.h"

namespace railstep {

// Whether what runs on a suspension and was read from a block is there, in range and in its order.

bool travel_is_valid(const TravelModel& travel) noexcept;
bool suspended_is_valid(const Model& model, const SuspendedModel& body) noexcept;
bool runners_are_valid(const Model& model) noexcept;

}  // namespace railstep
