#include "offline/irregularity/sincos.h"

#include <cmath>

namespace railstep {

namespace {

constexpr double kPi = 3.14159265358979323846;

/// Taylor's series, good to 1e-17 up to pi / 4.
double sine_of(double x) {
  const double s = x * x;
  double sum = 1.;
  for (int n = 18; n >= 2; n -= 2) sum = 1. - s / (n * (n + 1.)) * sum;
  return x * sum;
}
double cosine_of(double x) {
  const double s = x * x;
  double sum = 1.;
  for (int n = 18; n >= 2; n -= 2) sum = 1. - s / (n * (n - 1.)) * sum;
  return sum;
}

}  // namespace

CosineSine cosine_sine(double t) {
  const double quarters = std::nearbyint(4. * (t - std::nearbyint(t)));  // -2 to 2, exact
  const double angle = 2. * kPi * ((t - std::nearbyint(t)) - .25 * quarters);
  const double c = cosine_of(angle), s = sine_of(angle);
  switch (static_cast<int>(quarters)) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case -1:
      return {s, -c};
    default:
      return {-c, -s};
  }
}

}  // namespace railstep
