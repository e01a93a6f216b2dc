#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>

#include "offline/irregularity/random.h"

namespace railstep::property {

/// Random numbers of a seed in order, the same on every machine.
class Draw {
 public:
  explicit Draw(std::uint64_t seed, std::uint64_t stream = 0) : seed_(seed), stream_(stream) {}
  double between(double a, double b) { return a + (b - a) * uniform(seed_, stream_, index_++); }
  /// A number of two digits: a person can read the text, and sums are not all round.
  double of_any_size(double a, double b) {
    const double x = a * std::pow(b / a, between(0., 1.));
    const double unit = std::pow(10., std::floor(std::log10(x)) - 1.);
    return std::round(x / unit) * unit;
  }
  bool chance(double p) { return between(0., 1.) < p; }
  int whole(int a, int b) { return a + static_cast<int>(between(0., b - a + 1.)); }
  template <typename T>
  T one_of(std::initializer_list<T> of) {
    return of.begin()[whole(0, static_cast<int>(of.size()) - 1)];
  }
  const char* one_of(std::initializer_list<const char*> of) {
    return of.begin()[whole(0, static_cast<int>(of.size()) - 1)];
  }

 private:
  std::uint64_t seed_, stream_, index_ = 0;
};

}  // namespace railstep::property
