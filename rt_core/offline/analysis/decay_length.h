#pragma once
#include "offline/track/track.h"

namespace railstep {

/// Length over which the static deflection beside a load falls to e^-7, 1e-3, m: 7 (4 EI/k)^(1/4)
/// of a beam on a foundation (Zimmermann), k of the softer rail's pads and ballast in series over
/// the bay. Infinite where nothing holds it up.
double decay_length(const Track& track);

}  // namespace railstep
