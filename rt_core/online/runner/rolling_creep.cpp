#include "online/runner/rolling_creep.h"

#include <cstddef>

#include "online/math/scalar.h"
#include "online/math/search.h"
#include "online/patch/creep.h"

namespace railstep {

namespace {

constexpr double kLeastSize = 1e-10;  // of linear creep over the limit: it has a direction beyond

/// Linear creep: forces along and across and the moment over creepages, N, N m and N m2.
struct LinearCreep {
  double by[3][3];
};

LinearCreep linear_creep(const CreepPatch& p) noexcept {
  const double area = p.half_length * p.half_width, root = square_root(area);
  const double force = p.shear * area, spin = force * root * p.kalker.c23;
  return {{{-force * p.kalker.c11, 0., 0.},
           {0., -force * p.kalker.c22, -spin},
           {0., spin, -force * area * p.kalker.c33}}};
}

double sum_of(const double* row, const double* x) noexcept {
  return (row[0] * x[0] + row[1] * x[1]) + row[2] * x[2];
}

void take_linear(const LinearCreep& linear, const double* creepage, ContactCreep& found) noexcept {
  for (int i = 0; i < 3; ++i) {
    found.force[i] = sum_of(linear.by[i], creepage);
    for (int k = 0; k < 3; ++k) found.by_slip[i][k] = linear.by[i][k];
  }
}

/// Forces by a law, and the linear moment, less by Shen, Hedrick and Elkins' factor of linear creep
/// over the limit: other laws have forces where linear ones are 0.
void saturate(const RollingCreep& c, const CreepPatch& patch, const LinearCreep& linear,
              const double* creepage, CreepWanted wanted, ContactCreep& found) noexcept {
  const CreepForce force =
      creep_force(c.law, c.strips, patch, {creepage[0], creepage[1], creepage[2]}, wanted);
  const double x = sum_of(linear.by[0], creepage), y = sum_of(linear.by[1], creepage),
               moment = sum_of(linear.by[2], creepage);
  const double size = square_root(x * x + y * y), u = size / patch.limit;
  found.size = u;
  const bool slides = found.slides();
  const double factor = slides ? 1. / u : 1. - u * (1. / 3.) + u * u * (1. / 27.);
  found.force[0] = force.x;
  found.force[1] = force.y;
  found.force[2] = factor * moment;
  if (wanted == CreepWanted::force) return;
  const double by_u = slides ? -1. / (u * u) : -1. / 3. + u * (2. / 27.);
  for (int k = 0; k < 3; ++k) {
    found.by_slip[0][k] = force.slope[0][k];
    found.by_slip[1][k] = force.slope[1][k];
    const double grows = size > kLeastSize * patch.limit
                             ? (x * linear.by[0][k] + y * linear.by[1][k]) / (size * patch.limit)
                             : 0.;
    found.by_slip[2][k] = factor * linear.by[2][k] + by_u * grows * moment;
  }
}

/// Derivatives over the normal force N. Half lengths are of N^g: forces are N times a function of
/// both creepages times N^(2g - 1) and of the spin times N^(3g - 1), the moment is N^g times that.
void find_by_normal(double exponent, double normal, const double* creepage,
                    ContactCreep& found) noexcept {
  const double power = 1. - 2. * exponent, spin = 1. - 3. * exponent;
  for (int i = 0; i < 3; ++i) {
    const double* const by = found.by_slip[i];
    const double own = i == 2 ? 1. + exponent : 1.;
    found.by_normal[i] =
        (own * found.force[i] -
         (power * (by[0] * creepage[0] + by[1] * creepage[1]) + spin * (by[2] * creepage[2]))) /
        normal;
  }
}

/// The same with x and the moment the other way round.
void mirror(ContactCreep& creep) noexcept {
  for (int i = 0; i < 3; i += 2) {
    creep.force[i] = -creep.force[i];
    creep.by_normal[i] = -creep.by_normal[i];
    creep.by_slip[i][1] = -creep.by_slip[i][1];
    creep.by_slip[1][i] = -creep.by_slip[1][i];
  }
}

}  // namespace

ContactCreep creep_by_law(const RollingCreep& c, const RollingPatch& of, double friction,
                          const Pressed& pressed, const Slip<double>& slip, double speed,
                          CreepWanted wanted) noexcept {
  ContactCreep found{};
  const double size = of.exponent > 0. ? square_root(pressed.depth) : 1.;
  const CreepPatch patch{size * of.half_length, size * of.half_width, of.shear,
                         friction * pressed.normal, of.kalker};
  const LinearCreep linear = linear_creep(patch);
  const double per_speed = per_rolling(speed);
  const bool backwards = speed < 0.;  // the mirror image of rolling ahead
  const double ahead = backwards ? -per_speed : per_speed;
  const double creepage[3] = {ahead * slip.along, per_speed * slip.across, ahead * slip.spin};
  if (c.law == CreepLaw::linear)
    take_linear(linear, creepage, found);
  else
    saturate(c, patch, linear, creepage, wanted, found);
  if (wanted == CreepWanted::slopes) {
    find_by_normal(of.exponent, pressed.normal, creepage, found);
    for (int i = 0; i < 3; ++i)
      for (double& slope : found.by_slip[i]) slope *= per_speed;
  }
  if (backwards) mirror(found);
  return found;
}

void grip_at(const RollingFriction& f, double x, double* part) noexcept {
  part[0] = part[1] = 1.;
  if (f.places == 0) return;
  const std::int32_t at = row_at(f.parts, 3, f.places, x);
  const double* const row = f.parts + std::ptrdiff_t{3} * at;
  const bool beyond = x <= row[0] || at == f.places - 1;
  const double* const next = beyond ? row : row + 3;
  const double along = beyond ? 0. : (x - row[0]) / (next[0] - row[0]);
  for (int side = 0; side < 2; ++side)
    part[side] = row[1 + side] + along * (next[1 + side] - row[1 + side]);
}

double left_by_slip(const RollingFriction& f, const Slip<double>& slip) noexcept {
  const double size = std::sqrt(slip.along * slip.along + slip.across * slip.across);
  return f.kinetic + (1. - f.kinetic) * f.half / (f.half + size);
}

void add_fall(const RollingFriction& f, double part, const Slip<double>& slip,
              const Slip<double>& over_rail, ContactCreep& creep) noexcept {
  const double size =
      std::sqrt(over_rail.along * over_rail.along + over_rail.across * over_rail.across);
  if (!(size > 0.)) return;
  const double slower = f.half + size,
               by_size = -(1. - f.kinetic) * f.half / (slower * slower) / (size * part);
  for (int k = 0; k < 3; ++k) {
    double* const own = creep.by_slip[k];
    // The derivative over friction, times the friction.
    const double by_friction =
        creep.force[k] - ((own[0] * slip.along + own[1] * slip.across) + own[2] * slip.spin);
    own[0] += by_friction * by_size * over_rail.along;
    own[1] += by_friction * by_size * over_rail.across;
  }
}

}  // namespace railstep
