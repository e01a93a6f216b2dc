#pragma once

namespace railstep {

/// Rows of a panel. Every kernel keeps this many sums side by side for every vector width, so that
/// each sum is taken in the same written order on all machines.
inline constexpr int kLanes = 8;

/// Sum of the 8 lanes, halves first: ((0+4)+(2+6)) + ((1+5)+(3+7)).
inline double lane_sum(const double* s) noexcept {
  return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
}

}  // namespace railstep
