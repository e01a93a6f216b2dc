#pragma once
#include <cmath>

namespace railstep {

/// The place between two others at which a function of opposite signs there is 0: false position
/// with Illinois' weights, bisected where it is slow. Also right at a jump through 0. If the signs
/// are alike, the result has no meaning; the caller checks this.
/// @param width  the search ends where the places are at most this far apart
template <class Function>
double bracketed_root(const Function& of, double low, double high, double width) {
  double at_low = of(low), at_high = of(high);
  if (at_low == 0.) return low;
  for (int iteration = 0; iteration < 200 && std::abs(high - low) > width && at_high != 0.;
       ++iteration) {
    const double cut = high - at_high * (high - low) / (at_high - at_low);
    const double place = iteration % 3 == 2 ? .5 * (low + high) : cut;
    const double at = of(place);
    if ((at > 0.) != (at_high > 0.)) {
      low = high;
      at_low = at_high;
    } else if (iteration % 3 != 2) {
      at_low *= .5;
    }
    high = place;
    at_high = at;
  }
  return high;
}

}  // namespace railstep
