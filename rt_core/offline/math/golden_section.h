#pragma once
#include <cmath>
#include <utility>

namespace railstep {

/// The place of a function's maximum between two places, and its value there, by golden section;
/// the function rises to one top between them.
/// @param width  the search ends where the places are no farther apart than this, or than rounding
///               can tell
template <class Function>
std::pair<double, double> golden_section(const Function& of, double low, double high,
                                         double width) {
  const double golden = .5 * (std::sqrt(5.) - 1.);
  double a = high - golden * (high - low), b = low + golden * (high - low);
  double at_a = of(a), at_b = of(b);
  while (high - low > width && low < a && a < b && b < high) {
    if (at_a > at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - golden * (high - low);
      at_a = of(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + golden * (high - low);
      at_b = of(b);
    }
  }
  return at_a > at_b ? std::pair(a, at_a) : std::pair(b, at_b);
}

}  // namespace railstep
