#pragma once
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <string>

#include "support/sanitized.h"

namespace railstep {

/// Longest time that a test waits, however busy the machine is. ctest ends a test that hangs after
/// more than twice that (CMakeLists.txt).
#if defined(RAILSTEP_SANITIZED) || !defined(__OPTIMIZE__)
inline constexpr std::chrono::seconds kPatience{800};
#else
inline constexpr std::chrono::seconds kPatience{120};
#endif

/// The moment at which a test stops waiting.
class Deadline {
 public:
  explicit Deadline(std::chrono::seconds from_now = kPatience)
      : end_(std::chrono::steady_clock::now() + from_now) {}
  [[nodiscard]] bool passed() const { return std::chrono::steady_clock::now() > end_; }

 private:
  std::chrono::steady_clock::time_point end_;
};

/// Calls `done` once a millisecond until it is true or the deadline has passed.
/// @returns whether it became true
inline bool waited(const std::function<bool()>& done, const Deadline& deadline = Deadline()) {
  while (!done()) {
    if (deadline.passed()) return false;
    usleep(1000);
  }
  return true;
}

/// Waits for `done` and fails the test case if it does not become true. Only for the test's own
/// thread.
inline void wait_until(const std::function<bool()>& done, const std::string& what,
                       std::chrono::seconds most = kPatience) {
  if (!waited(done, Deadline(most))) FAIL("waited " << most.count() << " s in vain for " << what);
}

}  // namespace railstep
