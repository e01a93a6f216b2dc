#include "offline/irregularity/sincos.h"

#include <cmath>

#include "online/math/sine.h"

namespace railstep {

namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

CosineSine cosine_sine(double t) {
  const double quarters = std::nearbyint(4. * (t - std::nearbyint(t)));  // -2 to 2, exact
  const double angle = 2. * kPi * ((t - std::nearbyint(t)) - .25 * quarters);
  // Up to pi / 4: good to 1e-17.
  const double square = angle * angle, c = cosine_series(square, 18);
  const double s = angle * sinc_series(square, 18);
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
