#include "offline/pack/course.h"

#include <cmath>
#include <stdexcept>

#include "online/model/course.h"

namespace railstep {

namespace {

constexpr std::int64_t kMostSteps = std::int64_t{1} << 20;  // of a period

struct Fraction {
  std::int64_t p, q;
};

/// The convergent of x that has its value to rounding; q = 0: none with q <= kMostSteps.
Fraction fraction_of(double x) {
  Fraction before{1, 0}, last{0, 1};  // of the continued fraction 0 + 1/(a1 + 1/(a2 + ...))
  double rest = x;
  for (int turn = 0; turn < 64; ++turn) {
    if (std::abs(x - static_cast<double>(last.p) / static_cast<double>(last.q)) <= 0x1p-51 * x)
      return last;
    rest = 1. / rest;
    if (!(rest < static_cast<double>(kMostSteps) + 1.)) break;
    const auto whole = static_cast<std::int64_t>(rest);
    const Fraction next{whole * last.p + before.p, whole * last.q + before.q};
    if (next.q > kMostSteps) break;
    before = last;
    last = next;
    rest -= static_cast<double>(whole);
  }
  return {0, 0};
}

}  // namespace

Course course_of(double bays_per_step) {
  if (!(bays_per_step >= 0.) || !(bays_per_step < 1.))
    throw std::invalid_argument(
        "on a track without end traffic goes forward, less than a bay in a step");
  const Fraction exact = fraction_of(bays_per_step);
  if (exact.q == 0)
    return {std::int64_t{1} << 62, 0, static_cast<std::int64_t>(std::ldexp(bays_per_step, 62))};
  __extension__ using Wide = unsigned __int128;
  const Wide parts = (static_cast<Wide>(exact.p) << 62) / static_cast<Wide>(exact.q);
  return {exact.q, exact.p, static_cast<std::int64_t>(parts)};
}

}  // namespace railstep
