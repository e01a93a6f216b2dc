#pragma once
#include <cstdint>

#include "online/model/model.h"

namespace railstep {

/// What a frame of a model takes at most: loads all on, every wheel on its rail, every contact,
/// port and iteration at its cap. Counted from the loops of the online sources, kernel by kernel;
/// what depends on the model's sizes is exact, what does not is rounded up. Track sensors are read
/// between frames and stand beside.
Cost cost_of(const Model& model);

/// Of one step of a system of bodies and beams, its part of the track's lines included.
Cost system_cost(const Model& model);
/// Of one step's wheels, flanges and fixed ports, their rows and responses included.
Cost contact_cost(const Model& model);

/// Of one way through solve_ports() with n ports: its start, its capped iterations, each with its
/// steps shortened as often as they may be, and what is left at the cap.
/// @param means  whether laws of contacts are means over the step
Cost ports_cost(std::int64_t n, bool means = false);

inline constexpr Cost operator+(Cost a, Cost b) {
  return {a.flops + b.flops, a.bytes + b.bytes, a.instructions + b.instructions};
}
inline constexpr Cost operator*(std::int64_t times, Cost a) {
  return {times * a.flops, times * a.bytes, times * a.instructions};
}

/// Arithmetic, and doubles that it reads and writes: an instruction for each of them at most, as a
/// vector of two does two of either and what is left pays for the loop.
inline constexpr Cost work(std::int64_t flops, std::int64_t doubles) {
  return {flops, 8 * doubles, flops + doubles};
}
/// The same of unrolled code with more sums at once than a processor has registers: they go to
/// memory and back.
inline constexpr Cost spilling(std::int64_t flops, std::int64_t doubles) {
  return {flops, 8 * doubles, flops + flops / 4 + doubles};
}
/// The same of code that is scalar and short, with its choices, indices, copies and calls.
inline constexpr Cost branching(std::int64_t flops, std::int64_t doubles) {
  return {flops, 8 * doubles, 2 * flops + 3 * doubles};
}

/// Of finding the row of a time in a table by bisection, and the value there.
inline constexpr Cost table_cost(std::int64_t rows) {
  std::int64_t halvings = 0;
  for (std::int64_t left = rows; left > 0; left /= 2) ++halvings;
  return rows == 0 ? Cost{} : branching(8, 6 + 2 * halvings);
}

}  // namespace railstep
