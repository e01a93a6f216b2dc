#pragma once
#include <cstdint>
#include <vector>

#include "online/model/signal.h"

namespace railstep {

/// The memory that a SignalModel refers to.
struct Signal {
  double start = 0., step = 1.;  // m
  bool periodic = false;
  std::vector<double> coefficient = {};  // [intervals + 3] m; empty: no signal
  SignalModel model() const;
};

/// The cubic B-spline through samples at start + k step; one that is not periodic keeps its first
/// and last value beyond its ends, where it too is twice differentiable. Between samples it misses
/// a wave of length l by (2 pi step / l)^4 / 384 of its amplitude, to leading order.
/// @param samples  [at least 1], m; of a periodic signal one period
/// Throws Refused on no samples or a step that is not above 0.
Signal fit_signal(const std::vector<double>& samples, double start, double step, bool periodic);

/// The signal's mean over `length` around each place, as a contact patch of that length feels it:
/// the integral of the spline, exact at the samples, and their spline between.
/// @param length  m, at least 0
Signal averaged(const Signal& signal, double length);

}  // namespace railstep
