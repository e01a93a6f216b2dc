#pragma once
#include <limits>
#include <string>

namespace railstep {

/// An interval of accepted numbers. Infinite ends are never reached: no value read is infinite. An
/// end is NaN where it follows from a key that could not be read; it bounds nothing.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool least_itself = true;  // is `least` accepted, or only what is above it?
  bool most_itself = true;
  [[nodiscard]] bool holds(double value) const;  // false for NaN
  [[nodiscard]] std::string text() const;        // "above 0, at most 10"
};
inline Range any_number() { return {}; }
inline Range at_least(double least) { return {.least = least}; }
inline Range above(double least) { return {.least = least, .least_itself = false}; }
inline Range between(double least, double most) { return {.least = least, .most = most}; }
inline Range above_upto(double least, double most) {
  return {.least = least, .most = most, .least_itself = false};
}

}  // namespace railstep
