#include "hil/hil_pace.h"

#include <algorithm>
#include <ctime>

namespace railstep {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;  // ns

}  // namespace

std::int64_t MonotonicClock::now() const noexcept {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return time.tv_sec * kSecond + time.tv_nsec;
}

bool MonotonicClock::sleep_until(std::int64_t ns) const noexcept {
  // A signal wakes any one of the threads: this one looks by itself.
  constexpr std::int64_t kLook = kSecond / 10;
  for (;;) {
    if (interrupted != nullptr && interrupted->load(std::memory_order_relaxed)) return false;
    const std::int64_t until = std::min(ns, now() + kLook);
    const timespec time{until / kSecond, until % kSecond};
    if (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == 0 && until == ns)
      return true;
  }
}

}  // namespace railstep
