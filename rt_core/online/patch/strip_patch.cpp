#include "online/patch/strip_patch.h"

#include <cmath>

#include "online/math/pi.h"
#include "online/math/scalar.h"

namespace railstep {

namespace {

/// Terms of the sums of the law, one for each strip, side by side.
struct Terms {
  double square[kMostPatchStrips];  // l^2
  double length[kMostPatchStrips];  // l
  double near[kMostPatchStrips];    // 2 sqrt(l^2 + y^2) (K - E), its mean at both points
  double slope[kMostPatchStrips];   // of `near` over l^2: K / sqrt(l^2 + y^2)
};

/// Square of the distance of a strip from a point as a term of I2 sees it, in widths of strips.
/// @param x  square of the distance of the strip's middle
inline double seen_square(double x) noexcept {
  constexpr double kBeside = 1. / 12., kNear[4] = {.0338338, .0740, 1.5007, -.6918};
  const double near = kNear[0] + x * (kNear[1] + x * (kNear[2] + x * kNear[3]));
  return x < 1. ? near : x - kBeside;
}

/// A term of I2 and its slope.
struct Near {
  double value, slope;
};
/// With M the arithmetic-geometric mean of sqrt(l^2 + y^2) and y, K / sqrt(l^2 + y^2) is pi / (2
/// M), and K - E is K over l^2 + y^2 times the sum of 2^(n-1) c_n^2, c_0 = l. Three turns and a
/// fourth by its series are good to 5e-4 at y = 0.004 l, 5e-6 at 0.03 l.
inline Near near_of(double l2, double y2) noexcept {
  double a = square_root(l2 + y2), g = square_root(y2), power = .5, sum = .5 * l2, c = 0.;
  for (int step = 0; step < 3; ++step) {
    c = .5 * (a - g);
    const double mean = .5 * (a + g);
    g = square_root(a * g);
    a = mean;
    power *= 2.;
    sum += power * c * c;
  }
  const double per = 1. / a, rest = .25 * c * c * per;  // a less rest is the next mean
  const double over = .5 * kPi * per * (1. + rest * per);
  return {2. * over * (sum + 2. * power * rest * rest), over};
}

/// @param longest  l^2 at the point of least gap
void fill(const StripPatch& patch, double longest, Terms& terms) noexcept {
  const double width2 = patch.width * patch.width, twice = 2. * patch.radius;
  const double one = patch.collocation.first, other = patch.collocation.second;
  const double* const gap = patch.gap;
#pragma omp simd
  for (int i = 0; i < patch.strips; ++i) {
    const double own = longest - twice * gap[i];
    terms.square[i] = own > 0. ? own : 0.;
    terms.length[i] = square_root(terms.square[i]);
  }
#pragma omp simd
  for (int i = 0; i < patch.strips; ++i) {
    const double l2 = terms.square[i];
    const double p = (i - one) * (i - one), q = (i - other) * (i - other);
    const Near a = near_of(l2, width2 * seen_square(p)), b = near_of(l2, width2 * seen_square(q));
    terms.near[i] = .5 * (a.value + b.value);
    terms.slope[i] = l2 > 0. ? .5 * (a.slope + b.slope) : 0.;
  }
}

}  // namespace

PatchForce patch_force(const StripPatch& patch, double approach) noexcept {
  PatchForce found{};
  if (!(approach > 0.)) return found;
  const double longer = 2. * patch.radius * kVirtualPart;  // of l^2 over the approach
  Terms terms;
  fill(patch, longer * approach, terms);
  double squares = 0., moment = 0., area = 0., near = 0., near_slope = 0., wet = 0.;
  for (int i = 0; i < patch.strips; ++i) {
    squares += terms.square[i];
    moment += (i - patch.deepest) * terms.square[i];
    area += terms.length[i];
    near += terms.near[i];
    near_slope += terms.slope[i];
    wet += terms.slope[i] > 0. ? 1. : 0.;
  }
  if (!(squares > 0.) || !(approach > patch.collocation.gap)) return found;
  const double I1 = .5 * kPi * squares * patch.width, I2 = near * patch.width;
  const double held = approach - patch.collocation.gap;
  found.normal = .5 * kPi * kOfModulus * patch.modulus * held * I1 / I2;
  found.stiffness = found.normal * (1. / held + longer * (wet / squares - near_slope / near));
  found.half_length = square_root(longer * approach);  // at the point of least gap
  found.pressure = found.normal * found.half_length / I1;
  found.centre = patch.width * moment / squares;
  found.half_width = 2. * area * patch.width / (kPi * found.half_length);
  return found;
}

Collocation collocation_of(const StripPatch& patch, double approach) noexcept {
  const double level = kVirtualPart * approach;
  const double* const gap = patch.gap;
  double weight[kMostPatchStrips];
#pragma omp simd
  for (int i = 0; i < patch.strips; ++i) {
    const double deep = level - gap[i] > 0. ? level - gap[i] : 0.;
    weight[i] = deep * square_root(deep);
  }
  double sum = 0., moment = 0., squares = 0., gaps = 0.;
  for (int i = 0; i < patch.strips; ++i) {
    const double number = i - patch.deepest;
    sum += weight[i];
    moment += weight[i] * number;
    squares += weight[i] * (number * number);
    gaps += weight[i] * gap[i];
  }
  if (!(sum > 0.)) return {patch.deepest, patch.deepest, 0.};
  const double mean = moment / sum, spread = squares / sum - mean * mean;
  const double apart = spread > 0. ? square_root(spread) : 0.;
  return {(patch.deepest + mean) - apart, (patch.deepest + mean) + apart, gaps / sum};
}

double shift_by_tilt(const StripPatch& patch, double approach) noexcept {
  const double level = kVirtualPart * approach;
  double overlap = 0., moment = 0., wet = 0., first = 0., second = 0.;
  for (int i = 0; i < patch.strips; ++i) {
    const double deep = level - patch.gap[i], number = i - patch.deepest;
    const double own = deep > 0. ? deep : 0., is_wet = deep > 0. ? 1. : 0.;
    overlap += own;
    moment += own * number;
    wet += is_wet;
    first += is_wet * number;
    second += is_wet * (number * number);
  }
  if (!(overlap > 0.)) return 0.;
  const double mean = moment / overlap;
  return patch.width * patch.width * ((second - 2. * mean * first) + mean * mean * wet) / overlap;
}

}  // namespace railstep
