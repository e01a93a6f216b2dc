#pragma once
#include "online/model/state.h"
#include "online/runner/profile_contact.h"

namespace railstep {

// Wheels of runners on their rails.

/// @param before  s before the end of the step
/// @param slopes  out: derivatives along x; null: none
RailsUnder rails_under(const Model& model, const RunnerModel& runner, int wheelset,
                       std::int64_t step, double before, RailsUnder* slopes = nullptr) noexcept;

/// Force of a rail on a wheel of a wheelset by profiles or by cones.
/// @param side  1 of the left wheel, -1 of the right
WheelForce force_on_wheel(const RollingContact& c, double radius, double side, double speed,
                          const OverRail& at, const double* v, const RailRate& rate) noexcept;

/// The numbers that a state keeps of a wheel's force. @param to  [kWheelForces]
inline void keep_wheel_force(const WheelForce& force, double* to) noexcept {
  for (int d = 0; d < 3; ++d) to[d] = force.generalised[d];
  to[3] = force.on_section;
}

/// Place of a wheelset along the model's elements, m.
double element_place(const Model& model, const RunnerModel& runner, int wheelset, std::int64_t step,
                     double before) noexcept;

/// Publishes the wheels and wheelsets of all runners, and the forces that hold them at their
/// places.
/// @returns large_turn where a body has left its small-angle frame
Status publish_runners(const Model& model, const State& at, Outputs& outputs) noexcept;

}  // namespace railstep
