#pragma once
#include <atomic>
#include <cmath>
#include <cstdint>

#include "hil/hil_latency.h"

namespace railstep {

/// The answer to an overrun, which is a frame that ends after its slot. Slot k begins at start + k
/// periods and ends where slot k + 1 begins.
enum class Policy : std::int32_t {
  stop,      // the run ends behind that frame
  skip,      // the next frame takes the next slot that has not begun; those before it stay empty
  catch_up,  // every slot has its frame: the next ones begin at once until the schedule is met
  free_run   // no slots: frames begin one behind the other; one longer than a period counts
};

/// When frames are made. Slots are counted, never summed up, so that they do not drift.
struct Schedule {
  double period_ns = 0.;
  std::int64_t slots = 0;
  std::int64_t grace = 0;  // the first slots, whose times are not told and whose overruns are
                           // counted apart and passed over as skip does, whatever the policy
  Policy policy = Policy::stop;

  /// Begin of a slot after the first one's, ns.
  std::int64_t begin(std::int64_t slot) const noexcept {
    const double whole = std::floor(period_ns);
    return slot * static_cast<std::int64_t>(whole) +
           static_cast<std::int64_t>(
               std::floor(static_cast<double>(slot) * (period_ns - whole) + .5));
  }
  /// The first slot that begins at this time or later.
  std::int64_t first_from(std::int64_t ns) const noexcept {
    auto slot = static_cast<std::int64_t>(static_cast<double>(ns) / period_ns);
    while (slot > 0 && begin(slot - 1) >= ns) --slot;  // once at most: rounding
    while (begin(slot) < ns) ++slot;
    return slot;
  }
};

/// Counts of a paced run.
struct Paced {
  std::int64_t frames = 0;          // made
  std::int64_t overruns = 0;        // behind the grace
  std::int64_t grace_overruns = 0;  // in it
  std::int64_t skipped = 0;         // slots without a frame
  std::int64_t most_behind_ns = 0;  // longest time by which a frame ended after its slot
  bool stopped = false;             // by policy, at an overrun
  bool ended = false;               // by the frame itself or the clock, before the last slot
};

/// CLOCK_MONOTONIC, which cannot be set: a jump of the time of day does not change it.
struct MonotonicClock {
  const std::atomic<bool>* interrupted = nullptr;  // ends a sleep within 0.1 s; or null

  std::int64_t now() const noexcept;  // ns; no system call where the kernel has a vDSO
  /// Until an absolute time, so that what a frame took does not add up; signals alone do not cut
  /// it short.
  /// @returns false where it was interrupted
  bool sleep_until(std::int64_t ns) const noexcept;
};

/// Makes frames on their schedule. The clock is a parameter so that a test can be the time itself.
/// @param frame   called with a frame's index from 0; false ends the run
/// @param wakeup  of frames that slept: from their slot's begin to the first reading after it
/// @param work    what frames took
template <class Clock, class Frame>
Paced pace(const Schedule& plan, const Clock& clock, Frame&& frame, Latency& wakeup,
           Latency& work) noexcept {
  Paced met;
  const std::int64_t start = clock.now() + plan.begin(1);
  for (std::int64_t slot = 0; slot < plan.slots;) {
    const bool paced = plan.policy != Policy::free_run, graced = slot < plan.grace;
    const std::int64_t due = start + plan.begin(slot);
    const bool sleeps = paced && clock.now() < due;
    if (sleeps && !clock.sleep_until(due)) {
      met.ended = true;
      break;
    }
    const std::int64_t begun = clock.now();
    const bool goes_on = frame(met.frames);
    const std::int64_t done = clock.now();
    if (sleeps && !graced) wakeup.add(begun - due);
    if (!graced) work.add(done - begun);
    ++met.frames;
    ++slot;
    const std::int64_t behind = done - (paced ? start + plan.begin(slot) : begun + plan.begin(1));
    if (behind > 0) {
      ++(graced ? met.grace_overruns : met.overruns);
      if (behind > met.most_behind_ns) met.most_behind_ns = behind;
      met.stopped = !graced && plan.policy == Policy::stop;
      if (paced && (graced || plan.policy == Policy::skip)) {
        const std::int64_t next = plan.first_from(done - start);
        met.skipped += (next < plan.slots ? next : plan.slots) - slot;
        slot = next;
      }
    }
    met.ended = !goes_on;
    if (met.stopped || met.ended) break;
  }
  return met;
}

}  // namespace railstep
