#pragma once
#include <cstdint>
#include <vector>

#include "online/model/model.h"

namespace railstep {

/// The progress of traffic that moves by `bays_per_step` in a step, at least 0 and below 1. If this
/// is p/q to its own rounding, with q at most 2^20, traffic moves by p bays in q steps to the bit;
/// else it counts in 2^-62 of a bay. Throws Refused outside of the range.
BayProgress bay_progress(double bays_per_step);

/// A number of bays that takes a whole number of steps.
struct WholeBays {
  std::int64_t bays, steps;
};

/// The nearest ones below and above a progress, with up to `most` steps; fewer steps come first.
std::vector<WholeBays> whole_bays_near(double bays_per_step, std::int64_t most);

}  // namespace railstep
