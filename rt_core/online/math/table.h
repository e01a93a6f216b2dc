#pragma once
#include <cstddef>
#include <cstdint>

#include "online/math/search.h"

namespace railstep {

/// Value of a table [points][2] of rising times and values: linear between its rows, constant
/// outside them.
inline double table_value(const double* table, std::int32_t points, double time) noexcept {
  const std::int32_t at = row_at(table, 2, points, time);
  const double* const row = table + std::ptrdiff_t{2} * at;
  if (time <= row[0] || at == points - 1) return row[1];
  const double* const next = row + 2;
  return row[1] + (time - row[0]) / (next[0] - row[0]) * (next[1] - row[1]);
}

/// Weights of the four points around a place, out of intervals + 1 equally spaced ones over [-1,
/// 1].
struct Cubic {
  std::int32_t first;
  double weight[4];
};

/// Cubic Lagrange interpolation at xi; intervals >= 3.
inline Cubic cubic(std::int32_t intervals, double xi) noexcept {
  const double at = .5 * (xi + 1.) * intervals;
  std::int32_t first = static_cast<std::int32_t>(at) - 1;
  if (first < 0) first = 0;
  if (first > intervals - 3) first = intervals - 3;
  const double t = at - first;  // 0..3
  return {first,
          {-(t - 1.) * (t - 2.) * (t - 3.) / 6., t * (t - 2.) * (t - 3.) / 2.,
           -t * (t - 1.) * (t - 3.) / 2., t * (t - 1.) * (t - 2.) / 6.}};
}

inline double interpolate(const double* value, const Cubic& c) noexcept {
  const double* f = value + c.first;
  return (c.weight[0] * f[0] + c.weight[1] * f[1]) + (c.weight[2] * f[2] + c.weight[3] * f[3]);
}
inline double interpolate(const double* value, std::int32_t intervals, double xi) noexcept {
  return interpolate(value, cubic(intervals, xi));
}

}  // namespace railstep
