#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <string>

namespace railstep {

/// Estimates the time that is left from the time that the last tenth took, so that earlier parts
/// that took another time, or were done already, soon stop to count.
class Pace {
 public:
  /// @param seconds since the start
  void reached(int percent, double seconds);
  /// s; 0 at the start, where nothing is known
  double left() const;

 private:
  std::array<double, 101> at_{};  // s, by percent
  int percent_ = 0;
};

/// "40 s", "3 min", "2 h 10 min".
std::string duration_text(double seconds);

/// A bar on stderr, when that is a terminal, with the time left; moves once a percent, and is wiped
/// at its end.
class Progress {
 public:
  explicit Progress(std::int64_t all);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();
  void operator()(std::int64_t done);

 private:
  std::int64_t all_;
  bool shown_;
  int percent_ = -1;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  Pace pace_;
};

}  // namespace railstep
