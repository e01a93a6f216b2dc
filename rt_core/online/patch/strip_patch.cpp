#include "online/patch/strip_patch.h"

#include <cmath>

#include "online/math/scalar.h"

namespace railstep {

namespace {

/// Terms of the sums of the law, one for each strip, side by side.
struct Terms {
  double square[kMostPatchStrips];  // l^2
  double length[kMostPatchStrips];  // l
  double near[kMostPatchStrips];    // 2 sqrt(l^2 + y^2) (K - E)
  double slope[kMostPatchStrips];   // of `near` over l^2: K / sqrt(l^2 + y^2)
};

/// Terms of all strips. With M the arithmetic-geometric mean of sqrt(l^2 + y^2) and y, K / sqrt(l^2
/// + y^2) is pi / (2 M), and K - E is K over l^2 + y^2 times the sum of 2^(n-1) c_n^2, c_0 = l.
/// Five turns are good to 1e-12 where y is over 0.005 l.
/// @param longest  l^2 at the point of least gap
void fill(const StripPatch& patch, double longest, Terms& terms) noexcept {
  constexpr double kBeside = 1. / 12., kAtPoint = .033833820809153176;  // of width^2
  const double width2 = patch.width * patch.width;
#pragma omp simd
  for (int i = 0; i < patch.strips; ++i) {
    const double own = longest - 2. * patch.radius * patch.gap[i];
    const bool wet = own > 0.;
    const double l2 = wet ? own : 0.;
    const double number = i - patch.deepest;
    const double apart = number * number - kBeside;
    const double y2 = (apart < 0. ? kAtPoint : apart) * width2;
    double a = square_root(l2 + y2), g = square_root(y2), power = .5, sum = .5 * l2;
    for (int turn = 0; turn < 5; ++turn) {
      const double c = .5 * (a - g), mean = .5 * (a + g);
      g = square_root(a * g);
      a = mean;
      power *= 2.;
      sum += power * c * c;
    }
    const double over = .5 * M_PI / a;
    terms.square[i] = l2;
    terms.length[i] = square_root(l2);
    terms.near[i] = 2. * over * sum;
    terms.slope[i] = wet ? over : 0.;
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
  if (!(squares > 0.)) return found;
  const double I1 = .5 * M_PI * squares * patch.width, I2 = near * patch.width;
  found.normal = .5 * M_PI * kOfModulus * patch.modulus * approach * I1 / I2;
  found.stiffness = found.normal * (1. / approach + longer * (wet / squares - near_slope / near));
  found.half_length = square_root(longer * approach);  // at the point of least gap
  found.pressure = found.normal * found.half_length / I1;
  found.centre = patch.width * moment / squares;
  found.half_width = 2. * area * patch.width / (M_PI * found.half_length);
  return found;
}

}  // namespace railstep
