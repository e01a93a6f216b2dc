#pragma once
#include <cmath>

namespace railstep {

/// Penetration at which P = C delta^1.5 holds a force >= 0, m. @param constant  C, N/m^1.5, > 0
inline double hertz_depth(double force, double constant) {
  return std::pow(force / constant, 2. / 3.);
}

}  // namespace railstep
