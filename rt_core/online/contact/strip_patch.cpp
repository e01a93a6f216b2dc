#include "online/contact/strip_patch.h"

#include <math.h>

namespace railstep {

namespace {

struct Elliptic {
  double K, less_E;  // K, K - E
};

/// Complete elliptic integrals by five turns of the arithmetic-geometric mean, good to 1e-12 for a
/// complementary modulus from 0.005.
/// @param k2  square of the modulus
Elliptic elliptic(double k2, double complementary) noexcept {
  double a = 1., g = complementary, power = .5, sum = .5 * k2;
  for (int turn = 0; turn < 5; ++turn) {
    const double c = .5 * (a - g), mean = .5 * (a + g);
    g = sqrt(a * g);
    a = mean;
    power *= 2.;
    sum += power * c * c;
  }
  const double K = M_PI / (2. * a);
  return {K, K * sum};
}

}  // namespace

PatchForce patch_force(const StripPatch& patch, double approach) noexcept {
  constexpr double kBeside = 1. / 12., kAtPoint = .033833820809153176;  // of width^2
  PatchForce found{};
  if (!(approach > 0.)) return found;
  const double longer = 2. * patch.radius * kVirtualPart;  // of l^2 over the approach
  double squares = 0., moment = 0., area = 0., near = 0., near_slope = 0., wet = 0.;
  for (int i = 0; i < patch.strips; ++i) {
    const double l2 = longer * approach - 2. * patch.radius * patch.gap[i];
    if (!(l2 > 0.)) continue;
    const double y = (i - patch.deepest) * patch.width;
    const double y2 = i == patch.deepest ? kAtPoint * patch.width * patch.width
                                         : y * y - kBeside * patch.width * patch.width;
    const double reach = sqrt(l2 + y2);
    const Elliptic e = elliptic(l2 / (l2 + y2), sqrt(y2) / reach);
    near += 2. * reach * e.less_E;
    near_slope += e.K / reach;
    squares += l2;
    moment += y * l2;
    area += sqrt(l2);
    wet += 1.;
  }
  if (!(squares > 0.)) return found;
  const double I1 = .5 * M_PI * squares * patch.width, I2 = near * patch.width;
  found.normal = .5 * M_PI * kOfModulus * patch.modulus * approach * I1 / I2;
  found.stiffness = found.normal * (1. / approach + longer * (wet / squares - near_slope / near));
  found.half_length = sqrt(longer * approach);  // at the point of least gap
  found.pressure = found.normal * found.half_length / I1;
  found.centre = moment / squares;
  found.half_width = 2. * area * patch.width / (M_PI * found.half_length);
  return found;
}

}  // namespace railstep
