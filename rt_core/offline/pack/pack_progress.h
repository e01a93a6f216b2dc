#pragma once
#include <cstdint>
#include <vector>

#include "online/model/model.h"

namespace railstep {

/// The progress of traffic that goes `bays_per_step` a step, 0 to below 1. Where that is p/q to its
/// own rounding, q at most 2^20, it goes p bays in q steps to the bit; else in 2^-62 of a bay.
/// Throws std::invalid_argument at 1 bay a step and beyond.
BayProgress bay_progress(double bays_per_step);

/// So many bays in so many steps.
struct WholeBays {
  std::int64_t bays, steps;
};

/// Those next to a progress on either side, of up to `most` steps, fewer steps first.
std::vector<WholeBays> whole_bays_near(double bays_per_step, std::int64_t most);

}  // namespace railstep
