#include "offline/runner/rolling_slopes.h"

#include <algorithm>
#include <cmath>

namespace railstep {

namespace {

WheelForce on_cone(const RollingContact& c, double radius, double side, const Rolling& rolling,
                   const double* u, const double* v, WheelSlopes& slopes) {
  const WheelRows<Placed> r =
      wheel_rows(c, radius, side, Placed::along(0, u[1]), Placed::along(1, u[2]),
                 Placed::along(2, u[3]), Placed::along(3, u[5]));
  if (!(r.depth.value > 0.)) return {r.depth.value, 0., 0., {}, 0., false, {}};
  const Slip<Placed> slip = slip_of(r, v, rolling.frame, radius, {});
  const Placed normal = normal_force(c, r.depth);
  const ContactCreep creep =
      creep_on_rail(c.creep, c.creep.patch, side, {r.depth.value, normal.value},
                    {slip.along.value, slip.across.value, slip.spin.value}, rolling);
  Placed by_creep[3];
  for (int i = 0; i < 3; ++i) {
    const double* const by = creep.by_slip[i];
    by_creep[i] = (by[0] * slip.along + by[1] * slip.across) +
                  (by[2] * slip.spin + creep.by_normal[i] * normal);
    by_creep[i].value = creep.force[i];
  }
  Placed sum[7];
  generalise(r, ContactForces<Placed>{normal, by_creep[0], by_creep[1], by_creep[2]}, sum);
  sum[6] = r.across_section * by_creep[1];
  const double along[6] = {1., 0., 0., r.along_roll.value, r.along_spin.value, r.along_yaw.value};
  const double across[6] = {
      0., r.n_z.value, -r.n_y.value, r.across_roll.value, r.across_spin.value, r.across_yaw.value};
  const double spin[6] = {0., 0., 0., r.spin_roll.value, r.spin_spin.value, r.n_z.value};
  for (int k = 0; k < 7; ++k) {
    for (int m = 0; m < 4; ++m) slopes.by_motion[k][m] = sum[k].slope[m];
    const double x = k < 6 ? along[k] : 0., y = k < 6 ? across[k] : r.across_section,
                 z = k < 6 ? spin[k] : 0.;
    double by_slip[3];
    for (int m = 0; m < 3; ++m)
      by_slip[m] = x * creep.by_slip[0][m] + y * creep.by_slip[1][m] + z * creep.by_slip[2][m];
    slopes.by_section_rate[k] = r.across_section * by_slip[1];
    for (int m = 0; m < 6; ++m)
      slopes.by_rate[k][m] = by_slip[0] * along[m] + by_slip[1] * across[m] + by_slip[2] * spin[m];
  }
  return wheel_force(c, radius, side, rolling, u, v, RailRate{});
}

struct Seven {
  double force[7];
};
Seven seven_of(const WheelForce& f) {
  Seven all{};
  std::copy_n(f.generalised, 6, all.force);
  all.force[6] = f.on_section;
  return all;
}

/// Half of the difference of two, over a step.
void take_difference(const WheelForce& more, const WheelForce& less, double step, int at,
                     int columns, double* slopes) {
  const Seven a = seven_of(more), b = seven_of(less);
  for (int k = 0; k < 7; ++k) slopes[k * columns + at] = (a.force[k] - b.force[k]) / (2. * step);
}

WheelForce on_profile(const RollingContact& c, double radius, double side, const Rolling& rolling,
                      const OverRail& at, const double* v, WheelSlopes& slopes) {
  constexpr double kPlace = 2e-6, kRate = 1e-6;  // m or rad; of the speed
  double u[6], rate[6];
  std::copy_n(at.motion, 6, u);
  std::copy_n(v, 6, rate);
  const auto placed = [&](double section) {
    return force_on_wheel(c, radius, side, rolling, {u, section}, v, RailRate{});
  };
  for (int m = 0; m < 4; ++m) {
    double& own = u[index_of(kPlaced[m])];
    const double kept = own;
    own = kept + kPlace;
    const WheelForce more = placed(at.section);
    own = kept - kPlace;
    take_difference(more, placed(at.section), kPlace, m, 4, slopes.by_motion[0]);
    own = kept;
  }
  take_difference(placed(at.section + kPlace), placed(at.section - kPlace), kPlace, 0, 1,
                  slopes.by_section);
  ProfileWheel wheel;
  find_profile_wheel(c, radius, side, at, wheel);
  double stiffness[kMostZones];
  const auto moving = [&](double section) {
    return profile_force(c, wheel, radius, side, rolling, at, rate, {0., 0., section}, stiffness);
  };
  const double small = kRate * (1. + std::fabs(rolling.frame));
  for (int m = 0; m < 6; ++m) {
    rate[m] = v[m] + small;
    const WheelForce more = moving(0.);
    rate[m] = v[m] - small;
    take_difference(more, moving(0.), small, m, 6, slopes.by_rate[0]);
    rate[m] = v[m];
  }
  take_difference(moving(small), moving(-small), small, 0, 1, slopes.by_section_rate);
  return moving(0.);
}

}  // namespace

WheelForce force_on_wheel(const RollingContact& c, double radius, double side,
                          const Rolling& rolling, const OverRail& at, const double* v,
                          WheelSlopes& slopes) {
  slopes = {};
  return has_profiles(c) ? on_profile(c, radius, side, rolling, at, v, slopes)
                         : on_cone(c, radius, side, rolling, at.motion, v, slopes);
}

}  // namespace railstep
