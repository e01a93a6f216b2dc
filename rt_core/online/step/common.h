#pragma once
#include "online/step/coupling.h"
#include "online/step/load.h"

namespace railstep {

/// What states of one model that are stepped side by side have in common at a step, found by the
/// first of them that comes to it. Loads and the wheels of vehicles stand where the time says,
/// whatever moves; wheelsets' contacts do not.
struct Common {
  std::int64_t pressed;         // the step whose forces these are, or -1
  double *force_re, *force_im;  // [unknowns] of loads and weight; im of condensed models
  std::int64_t published;       // the step whose loads these are, or -1
  PlacedLoad load[kMaxLoads];
  std::int64_t placed;  // the step whose wheels stand in `coupling`, or -1
  Coupling coupling;    // contacts, their places, what loads add there, W
};

}  // namespace railstep
