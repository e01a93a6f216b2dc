#pragma once
#include <utility>

#include "offline/pack/pack.h"
#include "offline/track/track.h"

namespace railstep {

/// Unknowns of the track, and those that the model carries of it; wheelsets stand beside.
std::pair<int, int> unknowns_of(const Track& track, const PackedModel& packed);

}  // namespace railstep
