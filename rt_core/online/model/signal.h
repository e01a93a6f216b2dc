#pragma once
#include <cstddef>
#include <cstdint>

namespace railstep {

/// A function of a place, twice differentiable: a uniform cubic B-spline. Interval i, from
/// start + i step on, is over coefficient[i] to coefficient[i + 3].
struct SignalModel {
  double start, step;         // m
  std::int32_t intervals;     // 0: no signal, 0 everywhere
  std::int32_t periodic;      // 1: it repeats every intervals * step; 0: constant beyond its ends
  const double* coefficient;  // [intervals + 3] m
};

struct SignalValue {
  double value, slope, curvature;  // m, 1, 1/m
};

namespace signal {

/// x modulo n, in [0, n); 0 if x is too large to have a remainder.
inline double wrapped(double x, double n) noexcept {
  const double periods = x / n;
  if (!(periods > -1e15 && periods < 1e15)) return 0.;
  double rest = x - static_cast<double>(static_cast<std::int64_t>(periods)) * n;
  if (rest < 0.) rest += n;
  return rest < n ? rest : 0.;
}

}  // namespace signal

/// Takes the same work for every place. A place that is not finite gives the value at the start.
inline SignalValue signal_at(const SignalModel& s, double place) noexcept {
  if (s.intervals == 0) return {0., 0., 0.};
  const double n = s.intervals;
  double at = (place - s.start) / s.step;
  if (s.periodic != 0 && at - at == 0.) at = signal::wrapped(at, n);
  if (!(at > 0.)) at = 0.;
  if (at > n) at = n;
  std::int32_t i = static_cast<std::int32_t>(at);
  if (i == s.intervals) --i;
  const double t = at - i, r = 1. - t;
  const double* c = s.coefficient + i;
  const double value =
      ((r * r * r) * c[0] + (t * t * t) * c[3]) +
      ((4. - 3. * (t * t) * (1. + r)) * c[1] + (4. - 3. * (r * r) * (1. + t)) * c[2]);
  const double slope =
      (t * t * c[3] - r * r * c[0]) + ((3. * t - 4.) * t * c[1] + (4. - 3. * r) * r * c[2]);
  const double curvature = (r * c[0] + t * c[3]) + ((3. * t - 2.) * c[1] + (3. * r - 2.) * c[2]);
  return {value / 6., .5 * slope / s.step, curvature / (s.step * s.step)};
}

}  // namespace railstep
