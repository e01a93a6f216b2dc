#pragma once
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <string>

namespace railstep {

/// How long a test waits at most, however busy the machine is; tests/CMakeLists.txt sets it by
/// build.
inline constexpr std::chrono::seconds kPatience{RAILSTEP_PATIENCE};

/// A moment after which a test waits no longer.
class Deadline {
 public:
  explicit Deadline(std::chrono::seconds from_now = kPatience)
      : end_(std::chrono::steady_clock::now() + from_now) {}
  [[nodiscard]] bool passed() const { return std::chrono::steady_clock::now() > end_; }

 private:
  std::chrono::steady_clock::time_point end_;
};

/// Waits for `done`, which is asked about once a millisecond.
/// @returns whether it was done before the deadline
inline bool waited(const std::function<bool()>& done, const Deadline& deadline = Deadline()) {
  while (!done()) {
    if (deadline.passed()) return false;
    usleep(1000);
  }
  return true;
}

/// The same, and the test case fails where it was not done. For the test's own thread.
inline void wait_until(const std::function<bool()>& done, const std::string& what,
                       std::chrono::seconds most = kPatience) {
  if (!waited(done, Deadline(most))) FAIL("waited " << most.count() << " s in vain for " << what);
}

}  // namespace railstep
