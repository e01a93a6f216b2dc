#pragma once
#include "online/model/state.h"
#include "online/step/table.h"

namespace railstep {

/// Takes a frame's inputs into the state: one that is not finite leaves the last good one, one
/// beyond its limit is cut to it.
/// @param value  [inputs] N or N m
/// @returns what was met
Status take_inputs(const Model& model, const double* value, State& state) noexcept;

/// What an input holds; 0 where there is no state yet.
inline double held_input(const double* input, std::int32_t at) noexcept {
  return input == nullptr ? 0. : input[at];
}

/// A force on a wheelset at a time, N.
/// @param input  State::input, or null before there is one
inline double force_at(const BodyForce& force, double time, const double* input) noexcept {
  return force.input >= 0 ? held_input(input, force.input)
                          : table_value(force.table, force.points, time);
}

}  // namespace railstep
