#pragma once
#include "online/math/table.h"
#include "online/model/state.h"

namespace railstep {

/// A force on a wheelset or a vehicle at a time, N or N m.
/// @param input  State::input, or null before there is a state
inline double force_at(const BodyForce& force, double time, const double* input) noexcept {
  return force.input >= 0 ? held_input(input, force.input)
                          : table_value(force.table, force.points, time);
}

/// Adds a vehicle's forces at a time to those along its coordinates.
/// @param sum  [vehicle.size]
inline void add_forces(const VehicleModel& vehicle, double time, const double* input,
                       double* sum) noexcept {
  for (std::int32_t i = 0; i < vehicle.forces; ++i)
    sum[vehicle.force[i].direction] += force_at(vehicle.force[i], time, input);
}

}  // namespace railstep
