#include "offline/pack/pack_progress.h"

#include <cmath>

#include "offline/math/refuse.h"
#include "online/model/progress.h"

namespace railstep {

namespace {

constexpr std::int64_t kMostSteps = std::int64_t{1} << 20;  // of a period

/// Convergents of the continued fraction of x: up to the first that equals x to rounding, or the
/// last with a denominator of at most `most`.
struct Convergents {
  WholeBays before{1, 0}, last{0, 1};
  bool exact = false;
};
Convergents convergents_of(double x, std::int64_t most) {
  Convergents c;  // of 0 + 1/(a1 + 1/(a2 + ...))
  double rest = x;
  for (int iteration = 0; iteration < 64; ++iteration) {
    const double value = static_cast<double>(c.last.bays) / static_cast<double>(c.last.steps);
    c.exact = std::abs(x - value) <= 0x1p-51 * x;
    if (c.exact) return c;
    rest = 1. / rest;
    if (!(rest < static_cast<double>(most) + 1.)) break;
    const auto whole = static_cast<std::int64_t>(rest);
    const WholeBays next{whole * c.last.bays + c.before.bays,
                         whole * c.last.steps + c.before.steps};
    if (next.steps > most) break;
    c.before = c.last;
    c.last = next;
    rest -= static_cast<double>(whole);
  }
  return c;
}

}  // namespace

BayProgress bay_progress(double bays_per_step) {
  if (!(bays_per_step >= 0.) || !(bays_per_step < 1.))
    refuse("E-PACK-36", "traffic on a track without end goes " + std::to_string(bays_per_step) +
                            " bays in a step; expected at least 0 and less than 1");
  const Convergents found = convergents_of(bays_per_step, kMostSteps);
  if (!found.exact)
    return {std::int64_t{1} << 62, 0, static_cast<std::int64_t>(std::ldexp(bays_per_step, 62))};
  __extension__ using Wide = unsigned __int128;
  const Wide parts =
      (static_cast<Wide>(found.last.bays) << 62) / static_cast<Wide>(found.last.steps);
  return {found.last.steps, found.last.bays, static_cast<std::int64_t>(parts)};
}

std::vector<WholeBays> whole_bays_near(double bays_per_step, std::int64_t most) {
  const auto [before, last, exact] = convergents_of(bays_per_step, most);
  // Up to the convergent after the last, before + k last approaches x from the side of `before`.
  const std::int64_t k = (most - before.steps) / last.steps;
  const WholeBays other{before.bays + k * last.bays, before.steps + k * last.steps};
  std::vector<WholeBays> near;
  for (const WholeBays& one : {last, other})
    if (one.bays > 0 && one.bays < one.steps) near.push_back(one);
  return near;
}

}  // namespace railstep
