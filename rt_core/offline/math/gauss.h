#pragma once
#include <vector>

namespace railstep {

struct GaussPoint {
  double xi, weight;
};

/// Gauss-Legendre rules of 1 to 5 points on [-1, 1] (Abramowitz and Stegun, table 25.4). Throws
/// Refused on another number.
std::vector<GaussPoint> gauss(int points);

}  // namespace railstep
