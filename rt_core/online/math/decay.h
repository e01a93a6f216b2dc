#pragma once

namespace railstep {

/// exp(-x) for x >= 0, the same on all machines; within 3e-14 of it, relative. 0 from x = 40 on.
inline double decay(double x) noexcept {
  if (!(x < 40.)) return 0.;
  constexpr int kHalvings = 7, kOrder = 13;  // x / 128 < 0.32
  const double part = x / (1 << kHalvings);
  double power = 1.;
  for (int n = kOrder; n > 0; --n) power = 1. - part / n * power;
  for (int i = 0; i < kHalvings; ++i) power *= power;
  return power;
}

}  // namespace railstep
