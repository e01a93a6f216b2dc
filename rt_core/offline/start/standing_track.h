#pragma once
#include "offline/pack/pack.h"

namespace railstep {

/// The rails under a vehicle that stands where its run starts: their places, and the masses,
/// dampers and springs that stand for the track under its wheels. They follow from the static
/// deflection under forces on the wheels' seats (Guyan's condensation), so that they hold for slow
/// motions; responses to forces are means over places in a bay. One-sided supports are springs.
/// @param runner  among those of the model, which must be at its start
/// Throws Refused where a wheel is beyond the rails.
RunningOn rails_at_rest(const PackedModel& packed, const Track& track, std::int32_t runner);

}  // namespace railstep
