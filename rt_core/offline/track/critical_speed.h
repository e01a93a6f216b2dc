#pragma once
#include <optional>

#include "offline/track/track.h"

namespace railstep {

/// The speed of a rail's slowest vertical waves, m/s, at which a load's own waves stay under it:
/// the least omega / k of a Timoshenko beam under its axial force on a bed, of waves of two bays
/// and longer. The bed is that of the support, smeared over a bay; sleepers move with the rail, on
/// pad and ballast in series. Without sleepers and on close seats exact, else an estimate.
/// @param rail  0 left, 1 right
/// @returns nothing where no spring holds the rail up
std::optional<double> critical_speed(const Track& track, int rail = 0);

}  // namespace railstep
