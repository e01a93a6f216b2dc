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

/// Adds the forces of tables and inputs at a time to those along a vehicle's coordinates.
/// @param sum  [bodies.size]
inline void add_forces(const SuspendedModel& bodies, double time, const double* input,
                       double* sum) noexcept {
  for (std::int32_t i = 0; i < bodies.forces; ++i)
    sum[bodies.force[i].direction] += force_at(bodies.force[i], time, input);
}

}  // namespace railstep
