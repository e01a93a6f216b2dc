#pragma once
#include "online/track/line.h"

namespace railstep {

/// Where a load stands at a step, over the undeformed rail, and what it weighs.
struct PlacedLoad {
  double x;      // m
  double place;  // the same along the model's elements, m
  double force;  // N, 0 when taken off
  double xi;
  bool on_rail;
  RailRow row;  // of the loaded point's vertical displacement
};

/// @param before  s, by how much it is looked for ahead of the step's end
PlacedLoad place(const Model& model, const LoadModel& load, std::int64_t step,
                 double before = 0.) noexcept;

/// Vertical displacement of the loaded point by the lines alone, m.
double deflection(const Model& model, const PlacedLoad& placed, const Configuration& at) noexcept;

}  // namespace railstep
