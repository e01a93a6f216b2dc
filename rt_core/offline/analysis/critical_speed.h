#pragma once
#include <optional>

#include "offline/track/track.h"

namespace railstep {

/// The critical speed of a load, m/s: the least speed at which its own waves stay under it. It is a
/// minimum of omega / k, where group and phase velocity are equal, over all branches of a
/// Timoshenko beam under its axial force on a bed, for waves of two bays and longer. The bed is
/// that of pads, sleepers and ballast, smeared over a bay. With sleepers the minimum is mostly on
/// the branch on which the rail moves against the sleepers. The lower branch ends at the frequency
/// of a sleeper between pad and ballast, and has a minimum only where pads are far stiffer than the
/// ballast. Exact for close seats, otherwise an estimate.
/// @param rail  0 left, 1 right
/// @returns nothing if there is no such wave: no spring holds the rail up, the axial force would
///          buckle it, or its seats are too far apart for the bed that holds it
std::optional<double> critical_speed(const Track& track, int rail = 0);

}  // namespace railstep
