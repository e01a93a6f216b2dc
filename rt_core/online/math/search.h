#pragma once
#include <cstddef>
#include <cstdint>

namespace railstep {

/// The last of `rows` rows of `width` numbers whose first number is not above `value`; the first
/// row if all are above it. First numbers rise; rows >= 1. It uses bisection, so that a long table
/// costs the same at its end as at its start: at most 31 iterations.
inline std::int32_t row_at(const double* table, std::int32_t width, std::int32_t rows,
                           double value) noexcept {
  std::int32_t low = 0, high = rows;  // the row is in [low, high)
  while (high - low > 1) {
    const std::int32_t middle = low + (high - low) / 2;
    if (table[std::ptrdiff_t{middle} * width] <= value)
      low = middle;
    else
      high = middle;
  }
  return low;
}

}  // namespace railstep
