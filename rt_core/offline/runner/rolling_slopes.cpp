#include "offline/runner/rolling_slopes.h"

namespace railstep {

WheelForce wheel_force(const RollingContact& c, double radius, double side, double speed,
                       const double* u, const double* v, WheelSlopes& slopes) {
  const WheelRows<Placed> r =
      wheel_rows(c, radius, side, Placed::along(0, u[1]), Placed::along(1, u[2]),
                 Placed::along(2, u[3]), Placed::along(3, u[5]));
  slopes = {};
  if (!(r.depth.value > 0.)) return {r.depth.value, 0., 0., {}, 0.};
  const double per_speed = per_rolling(speed);
  const ContactForces<Placed> f =
      contact_forces(c, r.depth, slip_of(c, r, v, speed, radius, {}), per_speed);
  Placed sum[7];
  generalise(r, f, sum);
  sum[6] = f.across;
  const double along[6] = {1., 0., 0., r.along_roll.value, r.along_spin.value, r.along_yaw.value};
  const double across[6] = {
      0., r.n_z.value, -r.n_y.value, r.across_roll.value, r.across_spin.value, r.across_yaw.value};
  const double spin[6] = {0., 0., 0., r.spin_roll.value, r.spin_spin.value, r.n_z.value};
  for (int k = 0; k < 7; ++k) {
    for (int m = 0; m < 4; ++m) slopes.by_motion[k][m] = sum[k].slope[m];
    // The seventh row is a unit force across.
    const double x = k < 6 ? along[k] : 0., y = k < 6 ? across[k] : 1., z = k < 6 ? spin[k] : 0.;
    const double by_along = -c.kalker[0] * x;
    const double by_across = c.kalker[2] * z - c.kalker[1] * y;
    const double by_spin = -c.kalker[2] * y - c.kalker[3] * z;
    slopes.by_across[k] = per_speed * by_across;
    for (int m = 0; m < 6; ++m)
      slopes.by_rate[k][m] =
          per_speed * (by_along * along[m] + by_across * across[m] + by_spin * spin[m]);
  }
  return wheel_force(c, radius, side, speed, u, v, RailRate{});
}

}  // namespace railstep
