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

/// All modes above 0.01 Hz, the lowest first; modes below are motions that nothing holds.
std::vector<RunningMode> running_modes(const LinearRunning& linear);

struct CriticalRunning {
  double speed;      // m/s
  double frequency;  // of the mode whose damping is 0 there, Hz
};

struct SpeedRange {
  double from, to;  // m/s
};

/// The least speed of a range at which a mode is no longer damped, to a relative 1e-10. The search
/// takes steps of at most 2 m/s and at most a hundredth of the range, so that it misses two
/// crossings within a step.
/// @param range  in and out: the part of it that was searched. In a curve a vehicle may find no
///               steady motion at its ends.
/// @returns nothing if all modes are damped over the range, or one is not at its start
/// Throws Failed if no steady motion is found at any speed.
std::optional<CriticalRunning> critical_running_speed(const Runner& runner,
                                                      const RunnerMatrices& matrices,
                                                      const RollingContact& contact,
                                                      SpeedRange& range, const RunningOn& on = {});

}  // namespace railstep
