#pragma once
#include <optional>

#include "offline/track/track.h"

namespace railstep {

/// The least speed at which a load's own waves stay under it, m/s: a least value of omega / k,
/// where waves carry energy at the speed of their crests, over all branches of a Timoshenko beam
/// under its axial force on a bed, of waves of two bays and longer. The bed is that of pads,
/// sleepers and ballast, smeared over a bay. On sleepers most beds have it on the branch on which
/// the rail moves against the sleepers: the lower one ends at the frequency of a sleeper between
/// pad and ballast, and has a least value only where pads are far stiffer than the ballast. Exact
/// for close seats, otherwise an estimate.
/// @param rail  0 left, 1 right
/// @returns nothing if there is no such wave: no spring holds the rail up, the axial force would
///          buckle it, or its seats are too far apart for what holds it
std::optional<double> critical_speed(const Track& track, int rail = 0);

}  // namespace railstep
