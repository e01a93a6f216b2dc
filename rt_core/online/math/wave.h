#pragma once
#include <cstdint>

namespace railstep {

/// sin(2 pi turns) within 4e-16 of what the rounded `turns` say; 0 where they are too many to have
/// a rest, or are no number. The C library's differs between machines.
inline double sine_of_turns(double turns) noexcept {
  if (!(turns > -1e15 && turns < 1e15)) return 0.;
  double rest = turns - static_cast<double>(static_cast<std::int64_t>(turns));  // -1 to 1
  if (rest > .5) rest -= 1.;
  if (rest < -.5) rest += 1.;
  if (rest > .25) rest = .5 - rest;
  if (rest < -.25) rest = -.5 - rest;
  const double x = 6.283185307179586477 * rest, s = x * x;  // up to a quarter turn: x^23/23! 1e-18
  double sum = 1.;
  for (int n = 10; n > 0; --n) sum = 1. - s / ((2. * n) * (2. * n + 1.)) * sum;
  return x * sum;
}

}  // namespace railstep
