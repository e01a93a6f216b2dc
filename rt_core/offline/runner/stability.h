#pragma once
#include <optional>
#include <vector>

#include "offline/runner/running.h"

namespace railstep {

/// An eigenvalue s of a vehicle that runs, its imaginary part not below 0.
struct RunningMode {
  double frequency;      // |s| / (2 pi), Hz
  double damping_ratio;  // -Re s / |s|
};

/// All modes above 0.01 Hz, the lowest first; below are the motions that nothing holds.
std::vector<RunningMode> running_modes(const LinearRunning& linear);

struct CriticalRunning {
  double speed;      // m/s
  double frequency;  // of the mode whose damping is 0 there, Hz
};

/// The least speed of a range at which a mode is no longer damped, to 1e-10 of itself. Speeds are
/// looked at in steps of 2 m/s and of a hundredth of the range at most, so that two crossings
/// within a step are missed.
/// @returns nothing if all modes are damped over the range, or one is not at its start
std::optional<CriticalRunning> critical_running_speed(const Runner& runner,
                                                      const RunnerMatrices& matrices,
                                                      const RollingContact& contact, double from,
                                                      double to, const RunningOn& on = {});

}  // namespace railstep
