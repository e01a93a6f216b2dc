#include "online/runner/rolling_contact.h"

namespace railstep {

namespace {

/// Slopes over the three kinds of slip, and so over the rates that make them.
void find_by_rate(const RollingContact& c, const WheelRows<Placed>& r, double per_speed,
                  WheelSlopes& slopes) noexcept {
  const double along[6] = {1., 0., 0., r.along_roll.value, r.along_spin.value, r.along_yaw.value};
  const double across[6] = {
      0., r.n_z.value, -r.n_y.value, r.across_roll.value, r.across_spin.value, r.across_yaw.value};
  const double spin[6] = {0., 0., 0., r.spin_roll.value, r.spin_spin.value, r.n_z.value};
  for (int k = 0; k < 7; ++k) {
    // The seventh row is a unit force across.
    const double x = k < 6 ? along[k] : 0., y = k < 6 ? across[k] : 1., s = k < 6 ? spin[k] : 0.;
    const double by_along = -c.kalker[0] * per_speed * x;
    const double by_across = (c.kalker[2] * s - c.kalker[1] * y) * per_speed;
    const double by_spin = -(c.kalker[2] * y + c.kalker[3] * s) * per_speed;
    slopes.by_across[k] = by_across;
    for (int m = 0; m < 6; ++m)
      slopes.by_rate[k][m] = by_along * along[m] + by_across * across[m] + by_spin * spin[m];
  }
}

}  // namespace

WheelForce wheel_force(const RollingContact& c, double radius, double side, double speed,
                       const double* u, const double* v, const RailRate& rail,
                       WheelSlopes& slopes) noexcept {
  const WheelRows<Placed> r =
      wheel_rows(c, radius, side, Placed::along(0, u[1]), Placed::along(1, u[2]),
                 Placed::along(2, u[3]), Placed::along(3, u[5]));
  WheelForce force{r.depth.value, 0., 0., {}, 0.};
  if (!(r.depth.value > 0.)) {
    slopes = {};
    return force;
  }
  const Slip<Placed> slip = slip_of(c, r, v, speed, radius, rail);
  const double per_speed = per_rolling(speed);
  const ContactForces<Placed> f = contact_forces(c, r.depth, slip, per_speed);
  force.normal = f.normal.value;
  force.across = f.across.value;
  force.creep_power = f.along.value * slip.along.value + f.across.value * slip.across.value +
                      f.moment.value * slip.spin.value;
  Placed sum[6];
  generalise(r, f, sum);
  for (int k = 0; k < 6; ++k) {
    force.generalised[k] = sum[k].value;
    for (int m = 0; m < 4; ++m) slopes.by_motion[k][m] = sum[k].slope[m];
  }
  for (int m = 0; m < 4; ++m) slopes.by_motion[6][m] = f.across.slope[m];
  find_by_rate(c, r, per_speed, slopes);
  return force;
}

}  // namespace railstep
