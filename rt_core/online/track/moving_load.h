#pragma once
#include "online/track/line.h"

namespace railstep {

/// Place of a load at a step on the undeformed rail, and its force.
struct PlacedLoad {
  double x;      // m
  double place;  // place along the model's elements, m
  double force;  // N, 0 if the load has been removed
  double xi;
  bool on_rail;
  RailRow row;  // of the loaded point's vertical displacement
};

/// @param before  s; the place is that at this time before the step's end
PlacedLoad place(const Model& model, const LoadModel& load, std::int64_t step,
                 double before = 0.) noexcept;

}  // namespace railstep
