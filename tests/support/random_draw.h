#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

namespace railstep {

/// Random numbers that are the same on every machine: 53 bits of the generator, without the
/// library's distributions.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : generator_(seed) {}
  double between(double a, double b) {
    return a + (b - a) * std::ldexp(static_cast<double>(generator_() >> 11), -53);
  }
  double of_any_size(double a, double b) { return a * std::pow(b / a, between(0., 1.)); }
  bool chance(double p) { return between(0., 1.) < p; }
  int whole(int a, int b) { return a + static_cast<int>(between(0., b - a + 1.)); }
  template <typename T, std::size_t n>
  T one_of(const std::array<T, n>& of) {
    return of[static_cast<std::size_t>(whole(0, static_cast<int>(n) - 1))];
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace railstep
