#pragma once
#include <cmath>

#include "online/math/dual.h"
#include "online/math/pi.h"
#include "online/math/scalar.h"
#include "online/patch/kalker.h"

namespace railstep {

/// A contact patch that rolls: an ellipse with a normal force and the limit of its creep force.
struct CreepPatch {
  double half_length, half_width;  // along the rail and across, m
  double shear;                    // modulus, N/m2
  double limit;                    // friction times normal force, N; above 0
  Kalker kalker;
};

/// Forces on the wheel, N.
template <class Real>
struct CreepPair {
  Real x, y;
};

/// Creepages: velocity of the wheel over the rail at the contact, over the speed.
template <class Real>
struct Creepages {
  Real along, across;  // 1
  Real spin;           // 1/m
};

namespace creep {

// Laws for numbers, Duals, and what else has sqrt() and value_of().

template <class Real>
double value_of(const Real& x) noexcept {
  return x.value;
}
template <>
inline double value_of(const double& x) noexcept {
  return x;
}

/// Linear creep over the limit, without its sign.
template <class Real>
CreepPair<Real> linear_part(const CreepPatch& p, const Creepages<Real>& c) noexcept {
  const double area = p.half_length * p.half_width;
  const double scale = p.shear * area / p.limit;
  const double spin = scale * std::sqrt(area) * p.kalker.c23;
  return {scale * p.kalker.c11 * c.along, scale * p.kalker.c22 * c.across + spin * c.spin};
}

template <class Real>
CreepPair<Real> linear(const CreepPatch& p, const Creepages<Real>& c) noexcept {
  const CreepPair<Real> part = linear_part(p, c);
  return {-p.limit * part.x, -p.limit * part.y};
}

/// Shen, Hedrick and Elkins (1983): the size of the linear force u over the limit becomes u - u^2/3
/// + u^3/27, and 1 from u = 3 on. As it saturates the force turns towards the slip: along (C1 xi,
/// C2 eta + spin's part) with C_i = (1 - w) c_ii + w (c11 + c22)/2, w = min(1, u/3)^2. The force is
/// continuous at u = 3; its derivatives jump there, as the turn ends.
template <class Real>
CreepPair<Real> she(const CreepPatch& p, const Creepages<Real>& c) noexcept {
  using std::sqrt;
  const CreepPair<Real> part = linear_part(p, c);
  const Real square = part.x * part.x + part.y * part.y;
  if (!(value_of(square) > 1e-20)) return {-p.limit * part.x, -p.limit * part.y};
  const Real size = sqrt(square);
  const bool slides = value_of(size) > 3.;
  const Real saturated = slides ? Real(1.) : size * (1. - size * (1. / 3.) + square * (1. / 27.));
  const Real turned = slides ? Real(1.) : square * (1. / 9.);
  const double scale = p.shear * p.half_length * p.half_width / p.limit;
  const double mean = .5 * (p.kalker.c11 + p.kalker.c22);
  const Real x = part.x + turned * (scale * (mean - p.kalker.c11)) * c.along;
  const Real y = part.y + turned * (scale * (mean - p.kalker.c22)) * c.across;
  const Real turned_square = x * x + y * y;
  // At 30 times the limit spin and the slip across may leave no direction.
  if (!(value_of(turned_square) > 1e-20))
    return {-p.limit * part.x / size, -p.limit * part.y / size};
  const Real factor = saturated / sqrt(turned_square) * -p.limit;
  return {factor * x, factor * y};
}

/// The arc tangent by three halvings and Taylor's series, within 1e-15 for values up to 1e150.
template <class Real>
Real arc_tangent(Real x) noexcept {
  using std::sqrt;
  for (int i = 0; i < 3; ++i) x = x / (1. + sqrt(1. + x * x));
  const Real square = x * x;
  Real sum(1. / 23.);
  for (int n = 21; n > 0; n -= 2) sum = 1. / n - square * sum;
  return 8. * x * sum;
}
template <int n>
Dual<n> arc_tangent(const Dual<n>& x) noexcept {
  return dual::chain(arc_tangent(x.value), 1. / (1. + x.value * x.value), x);
}

/// exp(-x) for x of at least 0, within 1e-12.
inline double falling_exponential(double x) noexcept {
  const double small = x / 1024.;
  double e = 1. - small * (1. - small / 2. * (1. - small / 3. * (1. - small / 4.)));
  for (int i = 0; i < 10; ++i) e *= e;
  return e;
}

/// Polach, A fast wheel-rail forces calculation computer code, Vehicle System Dynamics 33 (1999),
/// with his term of spin and no reduction of the adhesion.
template <class Real>
CreepPair<Real> polach(const CreepPatch& p, const Creepages<Real>& c) noexcept {
  using std::sqrt;
  const double a = p.half_length, b = p.half_width, area = a * b;
  const Real corrected = c.across + a * c.spin;
  const bool larger = magnitude(value_of(corrected)) > magnitude(value_of(c.across));
  const Real across = larger ? corrected : c.across;
  const Real square = c.along * c.along + across * across;
  if (!(value_of(square) > 1e-30)) return linear(p, c);
  const Real slip = sqrt(square);
  // The stiffness along the slip without spin.
  const Real plain = c.along * c.along + c.across * c.across;
  Real stiffness(p.kalker.c22);
  if (value_of(plain) > 1e-30) {
    const Real x = p.kalker.c11 * c.along, y = p.kalker.c22 * c.across;
    stiffness = sqrt((x * x + y * y) / plain);
  }
  const Real gradient = (.25 * kPi * p.shear * area / p.limit) * stiffness * slip;
  const Real force =
      -(2. * p.limit / kPi) * (gradient / (1. + gradient * gradient) + arc_tangent(gradient));
  // Spin.
  const double more = 1. + 6.3 * (1. - falling_exponential(a / b));
  const Real size = value_of(across) < 0. ? -across : across;
  const double by_spin = p.shear * p.kalker.c23 * std::sqrt(area);
  const Real of_spin = (8. * by_spin * area / (3. * p.limit * a * more)) * size;
  // With delta = (of_spin^2 - 1) / (of_spin^2 + 1): eta is 1 - delta, `root` that of 1 - delta^2.
  const Real eta = 2. / (1. + of_spin * of_spin), root = of_spin * eta;
  const Real moment =
      of_spin * (eta * eta * (.5 - eta * (1. / 3.))) - (1. / 3.) * root * root * root;
  const Real spin_force = (9. / 16.) * a * p.limit * more * moment * c.spin / slip;
  return {force * c.along / slip, force * c.across / slip + spin_force};
}

}  // namespace creep

}  // namespace railstep
