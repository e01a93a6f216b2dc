#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cerrno>
#include <limits>
#include <random>
#include <thread>
#include <vector>

#include "hil/hil_pace.h"

using namespace railstep;

namespace {

std::atomic<int> realtime_asked{0}, monotonic_asked{0}, bad_sleeps{0}, sleeps{0};

}  // namespace

// These replace the C library's functions: the time of day jumps by an hour at each reading, and
// every reading of a clock is counted.
extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const auto code = static_cast<int>(syscall(SYS_clock_gettime, clock, time));
  if (clock == CLOCK_REALTIME) time->tv_sec += 3600 * ++realtime_asked;
  if (clock == CLOCK_MONOTONIC) ++monotonic_asked;
  return code;
}
extern "C" int clock_nanosleep(clockid_t clock, int flags, const timespec* until, timespec* left) {
  ++sleeps;
  if (clock != CLOCK_MONOTONIC || flags != TIMER_ABSTIME) ++bad_sleeps;
  return syscall(SYS_clock_nanosleep, clock, flags, until, left) == 0 ? 0 : errno;
}

namespace {

constexpr double kPeriod = 1e6;  // ns

/// A clock that moves only where a test lets it: in frames, and a little at each wake-up.
struct FakeClock {
  std::int64_t* time;
  std::int64_t wakes_late = 0;
  std::int64_t now() const noexcept { return *time; }
  std::int64_t until = std::numeric_limits<std::int64_t>::max();  // time of an interruption
  bool sleep_until(std::int64_t ns) const noexcept {
    *time = ns + wakes_late;
    return ns < until;
  }
};

struct Told {
  Paced paced;
  std::vector<double> begun;  // start of each frame, in periods from the start of the first slot
  Latency wakeup, work;
};

/// Runs frames of 0.3 periods each except for one.
Told paced(Policy policy, std::int64_t slots, std::int64_t grace, std::int64_t long_frame,
           double long_periods, std::int64_t wakes_late = 0) {
  std::int64_t time = 123'456'789;
  const FakeClock clock{&time, wakes_late};
  const double first = static_cast<double>(time) + (policy == Policy::free_run ? 0. : kPeriod);
  Told told;
  told.paced = pace(
      {kPeriod, slots, grace, policy}, clock,
      [&](std::int64_t n) {
        told.begun.push_back((static_cast<double>(time) - first) / kPeriod);
        time += static_cast<std::int64_t>(kPeriod * (n == long_frame ? long_periods : .3));
        return true;
      },
      told.wakeup, told.work);
  return told;
}

void check_begun(const Told& told, const std::vector<double>& want) {
  REQUIRE(told.begun.size() == want.size());
  for (std::size_t i = 0; i < want.size(); ++i)
    CHECK(told.begun[i] == Approx(want[i]).margin(1e-9));
}

}  // namespace

TEST_CASE("stop ends the run after the frame that ended late", "[hil]") {
  const Told told = paced(Policy::stop, 10, 0, 2, 1.5);
  check_begun(told, {0., 1., 2.});
  CHECK(told.paced.stopped);
  CHECK(told.paced.overruns == 1);
  CHECK(told.paced.most_behind_ns == 500'000);
  CHECK(told.work.count() == 3);
}

TEST_CASE("a frame that ends with its slot is in time", "[hil]") {
  const Told told = paced(Policy::stop, 5, 0, 2, 1.);
  check_begun(told, {0., 1., 2., 3., 4.});
  CHECK_FALSE(told.paced.stopped);
  CHECK(told.paced.overruns == 0);
}

TEST_CASE("skip leaves the slots empty that have begun", "[hil]") {
  const Told told = paced(Policy::skip, 9, 0, 2, 2.5);
  check_begun(told, {0., 1., 2., 5., 6., 7., 8.});
  CHECK(told.paced.overruns == 1);
  CHECK(told.paced.skipped == 2);
  CHECK(told.paced.frames + told.paced.skipped == 9);
  check_begun(paced(Policy::skip, 9, 0, 2, 3.),
              {0., 1., 2., 5., 6., 7., 8.});  // the next slot begins at that time
  const Told at_the_end = paced(Policy::skip, 4, 0, 2, 7.);
  CHECK(at_the_end.paced.frames == 3);
  CHECK(at_the_end.paced.skipped == 1);
}

TEST_CASE("catch-up makes every frame without a wait until the schedule is met", "[hil]") {
  const Told told = paced(Policy::catch_up, 8, 0, 2, 2.5);
  check_begun(told, {0., 1., 2., 4.5, 4.8, 5.1, 6., 7.});
  CHECK(told.paced.overruns == 3);  // the long one and two that began late
  CHECK(told.paced.skipped == 0);
  CHECK(told.wakeup.count() == 5);  // of the frames that slept
}

TEST_CASE("free-run never waits and counts frames longer than a period", "[hil]") {
  const Told told = paced(Policy::free_run, 5, 0, 1, 1.2);
  check_begun(told, {0., .3, 1.5, 1.8, 2.1});
  CHECK(told.paced.overruns == 1);
  CHECK(told.wakeup.count() == 0);
}

TEST_CASE("an overrun within the grace time counts as none under every policy", "[hil]") {
  for (const Policy policy : {Policy::stop, Policy::skip, Policy::catch_up}) {
    const Told told = paced(policy, 9, 3, 1, 2.5);
    check_begun(told, {0., 1., 4., 5., 6., 7., 8.});
    CHECK_FALSE(told.paced.stopped);
    CHECK(told.paced.overruns == 0);
    CHECK(told.paced.grace_overruns == 1);
    CHECK(told.paced.skipped == 2);
    CHECK(told.work.count() == 5);  // frames in the grace time are not counted
  }
  CHECK(paced(Policy::stop, 9, 3, 3, 2.5).paced.stopped);  // the first frame after the grace time
}

TEST_CASE("wake-up latency is separate from the time of a frame", "[hil]") {
  const Told told = paced(Policy::skip, 50, 0, -1, 0., 7'000);
  CHECK(told.wakeup.quantile_us(.5) == Approx(7.));
  CHECK(told.work.quantile_us(.5) == Approx(300.));
  CHECK(told.wakeup.count() == 50);
  CHECK(told.paced.overruns == 0);
}

TEST_CASE("a frame may end the run", "[hil]") {
  std::int64_t time = 0;
  Latency wakeup, work;
  const Paced met = pace(
      {kPeriod, 10, 0, Policy::skip}, FakeClock{&time}, [](std::int64_t n) { return n < 4; },
      wakeup, work);
  CHECK(met.frames == 5);
  CHECK(met.ended);
  CHECK_FALSE(met.stopped);
}

TEST_CASE("an interrupted sleep ends the run before its frame", "[hil]") {
  std::int64_t time = 0;
  Latency wakeup, work;
  const FakeClock clock{&time, 0, static_cast<std::int64_t>(5.5 * kPeriod)};
  const Paced met = pace(
      {kPeriod, 10, 0, Policy::skip}, clock, [](std::int64_t) { return true; }, wakeup, work);
  CHECK(met.frames == 5);  // the first one begins a period after the start
  CHECK(met.ended);
}

TEST_CASE("a sleep of any length ends when it is interrupted", "[hil]") {
  std::atomic<bool> interrupted{false};
  const MonotonicClock clock{&interrupted};
  CHECK(clock.sleep_until(clock.now() + 1'000'000));
  constexpr std::int64_t kThousand = 1'000'000'000'000;  // s in ns
  const std::int64_t before = clock.now();
  std::thread other([&] {
    usleep(10'000);
    interrupted = true;
  });
  CHECK_FALSE(clock.sleep_until(before + kThousand));
  other.join();
  CHECK(clock.now() < before + kThousand);
  CHECK_FALSE(clock.sleep_until(before));
}

TEST_CASE("slots do not drift, and the first slot from a time on begins at that time or later",
          "[hil]") {
  const Schedule thirds{1e9 / 3., 1, 0, Policy::skip};
  for (const std::int64_t s : {1LL, 100LL, 86'400LL, 31'536'000LL})
    // A period is rounded to 2^-53 of itself: 2e-16 of the time. A slot adds half a ns.
    CHECK(std::abs(thirds.begin(3 * s) - s * 1'000'000'000) <= 1 + s / 5'000'000);
  std::mt19937_64 random(3);
  for (const double period : {1e3, 1e9 / 3., 62'500., 1e6 / 7., 1e12}) {
    const Schedule plan{period, 1, 0, Policy::skip};
    for (int n = 0; n < 2000; ++n) {
      const auto ns = static_cast<std::int64_t>(random() % 1'000'000'000'000ULL);
      const std::int64_t slot = plan.first_from(ns);
      CHECK(plan.begin(slot) >= ns);
      CHECK((slot == 0 || plan.begin(slot - 1) < ns));
    }
    CHECK(plan.first_from(plan.begin(12'345)) == 12'345);
  }
}

TEST_CASE("a jump of the time of day does not affect the pacing", "[hil]") {
  timespec day{}, later{};
  clock_gettime(CLOCK_REALTIME, &day);
  clock_gettime(CLOCK_REALTIME, &later);
  REQUIRE(later.tv_sec >= day.tv_sec + 3600);  // it does jump, and readings are counted
  REQUIRE(realtime_asked >= 2);
  realtime_asked = monotonic_asked = bad_sleeps = sleeps = 0;
  Latency wakeup, work;
  const MonotonicClock clock;
  const std::int64_t before = clock.now();
  const Paced met = pace(
      {kPeriod, 20, 0, Policy::catch_up}, clock, [](std::int64_t) { return true; }, wakeup, work);
  const std::int64_t took = clock.now() - before;
  const int looked = realtime_asked;  // before the test framework reads the clock
  CHECK(looked == 0);
  CHECK(met.frames == 20);
  CHECK(took >= 20 * static_cast<std::int64_t>(kPeriod));
  CHECK(monotonic_asked > 60);
  CHECK(sleeps > 0);
  CHECK(bad_sleeps == 0);
}
