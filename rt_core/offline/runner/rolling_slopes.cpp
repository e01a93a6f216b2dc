#include "offline/runner/rolling_slopes.h"

namespace railstep {

WheelForce wheel_force(const RollingContact& c, double radius, double side, double speed,
                       const double* u, const double* v, WheelSlopes& slopes) {
  const WheelRows<Placed> r =
      wheel_rows(c, radius, side, Placed::along(0, u[1]), Placed::along(1, u[2]),
                 Placed::along(2, u[3]), Placed::along(3, u[5]));
  slopes = {};
  if (!(r.depth.value > 0.)) return {r.depth.value, 0., 0., {}, 0., false};
  const Slip<Placed> slip = slip_of(c, r, v, speed, radius, {});
  const Placed normal = normal_force(c, r.depth);
  const ContactCreep creep =
      contact_creep(c.creep, friction_of(c.creep, side), r.depth.value, normal.value,
                    {slip.along.value, slip.across.value, slip.spin.value}, speed);
  Placed by_creep[3];
  for (int i = 0; i < 3; ++i) {
    const double* const by = creep.by_slip[i];
    by_creep[i] = (by[0] * slip.along + by[1] * slip.across) +
                  (by[2] * slip.spin + creep.by_normal[i] * normal);
    by_creep[i].value = creep.force[i];
  }
  Placed sum[7];
  generalise(r, ContactForces<Placed>{normal, by_creep[0], by_creep[1], by_creep[2]}, sum);
  sum[6] = by_creep[1];
  const double along[6] = {1., 0., 0., r.along_roll.value, r.along_spin.value, r.along_yaw.value};
  const double across[6] = {
      0., r.n_z.value, -r.n_y.value, r.across_roll.value, r.across_spin.value, r.across_yaw.value};
  const double spin[6] = {0., 0., 0., r.spin_roll.value, r.spin_spin.value, r.n_z.value};
  for (int k = 0; k < 7; ++k) {
    for (int m = 0; m < 4; ++m) slopes.by_motion[k][m] = sum[k].slope[m];
    // The seventh row is a unit force across.
    const double x = k < 6 ? along[k] : 0., y = k < 6 ? across[k] : 1., z = k < 6 ? spin[k] : 0.;
    double by_slip[3];
    for (int m = 0; m < 3; ++m)
      by_slip[m] = x * creep.by_slip[0][m] + y * creep.by_slip[1][m] + z * creep.by_slip[2][m];
    slopes.by_across[k] = by_slip[1];
    for (int m = 0; m < 6; ++m)
      slopes.by_rate[k][m] = by_slip[0] * along[m] + by_slip[1] * across[m] + by_slip[2] * spin[m];
  }
  return wheel_force(c, radius, side, speed, u, v, RailRate{});
}

}  // namespace railstep
