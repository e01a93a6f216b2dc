#pragma once
#include "online/model/state.h"
#include "online/runner/rolling_contact.h"

namespace railstep {

// Wheels of runners on their rails.

/// @param before  s before the end of the step
/// @param slopes  out: derivatives along x; null: none
RailsUnder rails_under(const Model& model, const RunnerModel& runner, int wheelset,
                       std::int64_t step, double before, RailsUnder* slopes = nullptr) noexcept;

/// Force of a rail on a wheel of a wheelset. @param u, v  [6] motions of the wheelset, their rates
/// @param slopes  out: derivatives; null: none
inline WheelForce wheel_force(const RunnerModel& runner, int wheelset, const RailsUnder& rails,
                              const RailRate& rate, int side, double speed, const double* u,
                              const double* v, ContactSlopes* slopes = nullptr) noexcept {
  const double over_rail[6] = {u[0], u[1] - rails.y[side], u[2] - rails.z[side], u[3], u[4], u[5]};
  const double radius = runner.wheelset[wheelset].radius, sign = side == 0 ? 1. : -1.;
  if (slopes == nullptr)
    return wheel_force(runner.contact, radius, sign, speed, over_rail, v, rate);
  return wheel_force(runner.contact, radius, sign, speed, over_rail, v, rate, *slopes);
}

/// The numbers that a state keeps of a wheel's force. @param to  [kWheelForces]
inline void keep_wheel_force(const WheelForce& force, double crown_radius, double* to) noexcept {
  for (int d = 0; d < 3; ++d) to[d] = force.generalised[d];
  to[3] = crown_radius * force.across;
}

/// Place of a wheelset along the model's elements, m.
double element_place(const Model& model, const RunnerModel& runner, int wheelset, std::int64_t step,
                     double before) noexcept;

/// Publishes the wheels and wheelsets of all runners, and the forces that hold them at their
/// places.
/// @returns large_turn where a body has left its small-angle frame
Status publish_runners(const Model& model, const State& at, Outputs& outputs) noexcept;

}  // namespace railstep
