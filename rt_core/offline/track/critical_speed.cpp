#include "offline/track/critical_speed.h"

#include <algorithm>
#include <cmath>

namespace railstep {
namespace {

struct Bed {
  double mass, rotary, shear, bending, pull, stiffness;  // kg/m, kg m, N, N m2, N, N/m2

  Bed(const Track& track, int rail) {
    const RailBar bar = track.bar(rail);
    mass = bar.material.density * bar.section.area;
    rotary = bar.material.density * bar.section.inertia_y;
    shear = bar.section.shear_factor_z * bar.material.shear_modulus() * bar.section.area;
    bending = bar.material.young * bar.section.inertia_y;
    pull = bar.axial_force;
    double seat = track.support.stiffness[2];
    if (track.sleeper) {
      const double ballast = track.sleeper->ballast_stiffness[2];
      mass += .5 * track.sleeper->mass / track.bay_length;
      seat = seat + ballast > 0. ? seat * ballast / (seat + ballast) : 0.;
    }
    stiffness = seat / track.bay_length;
  }

  /// Of waves e^(i k x), omega / k of the slower branch:
  /// mass w'' + (S k^2 + N k^2 + bed) w + S k a = 0, rotary a'' + (B k^2 + S) a + S k w = 0.
  [[nodiscard]] double speed(double k) const {
    const double along = ((shear + pull) * k * k + stiffness) / mass;
    const double turn = (bending * k * k + shear) / rotary;
    const double both = shear * k * shear * k / (mass * rotary);
    const double half = .5 * (along + turn);
    const double root = std::sqrt(.25 * (turn - along) * (turn - along) + both);
    return std::sqrt(std::max(0., (along * turn - both) / (half + root))) / k;
  }
};

}  // namespace

std::optional<double> critical_speed(const Track& track, int rail) {
  const Bed bed(track, rail);
  if (!(bed.stiffness > 0.)) return std::nullopt;
  // From waves so long that they are fast; omega / k has one least value there.
  double low = 1e-3, high = M_PI / track.bay_length;
  while (high / low > 1. + 1e-9) {
    const double a = std::cbrt(low * low * high), b = std::cbrt(low * high * high);
    (bed.speed(a) < bed.speed(b) ? high : low) = bed.speed(a) < bed.speed(b) ? b : a;
  }
  return bed.speed(std::sqrt(low * high));
}

}  // namespace railstep
