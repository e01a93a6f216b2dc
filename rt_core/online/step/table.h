#pragma once
#include <cstddef>
#include <cstdint>

namespace railstep {

/// Value of a table [points][2] of time and value: linear between its rows, constant outside them.
/// At most `points` turns.
inline double table_value(const double* table, std::int32_t points, double time) noexcept {
  const double* row = table;
  if (time <= row[0]) return row[1];
  for (std::int32_t i = 1; i < points; ++i) {
    const double* next = table + 2 * i;
    if (time < next[0]) return row[1] + (time - row[0]) / (next[0] - row[0]) * (next[1] - row[1]);
    row = next;
  }
  return row[1];
}

/// Cubic Lagrange interpolation of intervals + 1 equally spaced values over xi in [-1, 1], by the
/// four points around it; intervals >= 3.
inline double interpolate(const double* value, std::int32_t intervals, double xi) noexcept {
  const double at = .5 * (xi + 1.) * intervals;
  std::int32_t first = static_cast<std::int32_t>(at) - 1;
  if (first < 0) first = 0;
  if (first > intervals - 3) first = intervals - 3;
  const double t = at - first;  // 0..3
  const double* f = value + first;
  return -f[0] * (t - 1.) * (t - 2.) * (t - 3.) / 6. + f[1] * t * (t - 2.) * (t - 3.) / 2. -
         f[2] * t * (t - 1.) * (t - 3.) / 2. + f[3] * t * (t - 1.) * (t - 2.) / 6.;
}

/// y components of the mirrored right rail change sign: r_y, a_x, a_z, b_y.
constexpr bool flips_in_mirror(int k) noexcept { return k == 1 || k == 3 || k == 5 || k == 7; }

}  // namespace railstep
