#pragma once
#include <cstdint>

namespace railstep {

// Sines and cosines that are the same on all machines; those of C libraries differ.

/// cos x by Taylor's series up to x^order. @param square  x^2; order  even
inline double cosine_series(double square, int order) noexcept {
  double sum = 1.;
  for (int n = order; n > 0; n -= 2) sum = 1. - square / (n * (n - 1.)) * sum;
  return sum;
}
/// sin(x) / x in the same way.
inline double sinc_series(double square, int order) noexcept {
  double sum = 1.;
  for (int n = order; n > 0; n -= 2) sum = 1. - square / (n * (n + 1.)) * sum;
  return sum;
}

/// sin(2 pi turns) within 4e-16 for the rounded `turns`; 0 if these are too large to have a
/// fraction, or not a number.
inline double sine_of_turns(double turns) noexcept {
  if (!(turns > -1e15 && turns < 1e15)) return 0.;
  double rest = turns - static_cast<double>(static_cast<std::int64_t>(turns));  // -1 to 1
  if (rest > .5) rest -= 1.;
  if (rest < -.5) rest += 1.;
  if (rest > .25) rest = .5 - rest;
  if (rest < -.25) rest = -.5 - rest;
  const double x = 6.283185307179586477 * rest;  // up to a quarter turn: x^23/23! is 1e-18
  return x * sinc_series(x * x, 20);
}

}  // namespace railstep
