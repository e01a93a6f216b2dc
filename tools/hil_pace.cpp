#include "hil_pace.h"

#include <cerrno>
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

void MonotonicClock::sleep_until(std::int64_t ns) const noexcept {
  const timespec time{ns / kSecond, ns % kSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR) {
  }
}

}  // namespace railstep
