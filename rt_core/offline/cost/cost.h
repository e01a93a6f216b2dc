#pragma once
#include <cstdint>

#include "online/model/model.h"

namespace railstep {

/// Upper bound of the work of a frame: all loads act, every wheel is on its rail, and every
/// contact, port and iteration is at its cap. It is counted from the loops of the online sources,
/// kernel by kernel: terms that depend on the model's sizes are exact, others are rounded up. Track
/// sensors are read between frames and are counted separately.
Cost cost_of(const Model& model);

/// Cost of one step of a system of bodies and beams, including its part of the track's lines.
Cost system_cost(const Model& model);
/// Cost of one step's wheels, flanges and fixed ports, including their rows and responses.
Cost contact_cost(const Model& model);

/// Cost of one step's runners, and of what is published of them.
Cost runners_cost(const Model& model);
Cost publish_runners_cost(const Model& model);
/// Cost of one solve that couples runners with a track.
Cost coupled_runners_cost(const Model& model);

/// Cost of one call of solve_ports() with n ports: its start, its capped iterations, each with the
/// most shortenings of its step, and the end at the cap.
/// @param means  whether laws of contacts are means over the step
Cost ports_cost(std::int64_t n, bool means = false);

inline constexpr Cost operator+(Cost a, Cost b) {
  return {a.flops + b.flops, a.bytes + b.bytes, a.instructions + b.instructions};
}
inline constexpr Cost operator*(std::int64_t times, Cost a) {
  return {times * a.flops, times * a.bytes, times * a.instructions};
}

/// Arithmetic, and doubles that are read and written. Each takes one instruction at most: a vector
/// of two does two of either, and the rest pays for the loop.
inline constexpr Cost work(std::int64_t flops, std::int64_t doubles) {
  return {flops, 8 * doubles, flops + doubles};
}
/// The same for unrolled code with more sums at once than a processor has registers, so that they
/// go to memory and back.
inline constexpr Cost spilling(std::int64_t flops, std::int64_t doubles) {
  return {flops, 8 * doubles, flops + flops / 4 + doubles};
}
/// The same for short scalar code, with its branches, indices, copies and calls.
inline constexpr Cost branching(std::int64_t flops, std::int64_t doubles) {
  return {flops, 8 * doubles, 2 * flops + 3 * doubles};
}

/// Cost of finding the row of a time in a table by bisection, and the value there.
inline constexpr Cost table_cost(std::int64_t rows) {
  std::int64_t halvings = 0;
  for (std::int64_t left = rows; left > 0; left /= 2) ++halvings;
  return rows == 0 ? Cost{} : branching(8, 6 + 2 * halvings);
}

/// Cost of forces of tables and inputs, twice a step.
inline Cost forces_cost(const BodyForce* force, std::int32_t count) {
  Cost sum{};
  for (std::int32_t i = 0; i < count; ++i)
    sum = sum + 2 * (branching(2, 4) + table_cost(force[i].points));
  return sum;
}

}  // namespace railstep
