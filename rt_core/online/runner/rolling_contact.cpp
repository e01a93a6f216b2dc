#include "online/runner/rolling_contact.h"

namespace railstep {

namespace {

ContactForces<double> values(const ContactForces<Placed>& f) noexcept {
  return {f.normal.value, f.along.value, f.across.value, f.moment.value};
}

WheelRows<double> values(const WheelRows<Placed>& r) noexcept {
  return {r.depth.value,       r.n_y.value,         r.n_z.value,        r.normal_roll.value,
          r.normal_yaw.value,  r.along_roll.value,  r.along_spin.value, r.along_yaw.value,
          r.across_roll.value, r.across_spin.value, r.across_yaw.value, r.spin_roll.value,
          r.spin_spin.value};
}

void find_slopes(const RollingContact& c, const WheelRows<double>& r,
                 const ContactForces<Placed>& f, double per_speed, ContactSlopes& slopes) noexcept {
  const double normal[6] = {0., r.n_y, r.n_z, r.normal_roll, 0., r.normal_yaw};
  const double along[6] = {1., 0., 0., r.along_roll, r.along_spin, r.along_yaw};
  const double across[6] = {0., r.n_z, -r.n_y, r.across_roll, r.across_spin, r.across_yaw};
  const double spin[6] = {0., 0., 0., r.spin_roll, r.spin_spin, r.n_z};
  const double f11 = c.kalker[0] * per_speed, f22 = c.kalker[1] * per_speed,
               f23 = c.kalker[2] * per_speed;
  for (int k = 0; k < 6; ++k) {
    slopes.by_rate[0][k] = 0.;
    slopes.by_rate[1][k] = -f11 * along[k];
    slopes.by_rate[2][k] = -f22 * across[k] - f23 * spin[k];
    slopes.spread[k][0] = normal[k];
    slopes.spread[k][1] = along[k];
    slopes.spread[k][2] = across[k];
  }
  slopes.by_across[0] = slopes.by_across[1] = 0.;
  slopes.by_across[2] = -f22;
  for (int m = 0; m < 4; ++m) {
    slopes.by_motion[0][m] = f.normal.slope[m];
    slopes.by_motion[1][m] = f.along.slope[m];
    slopes.by_motion[2][m] = f.across.slope[m];
  }
}

}  // namespace

WheelForce wheel_force(const RollingContact& c, double radius, double side, double speed,
                       const double* u, const double* v, const RailRate& rail,
                       ContactSlopes& slopes) noexcept {
  const WheelRows<Placed> placed =
      wheel_rows(c, radius, side, Placed::along(0, u[1]), Placed::along(1, u[2]),
                 Placed::along(2, u[3]), Placed::along(3, u[5]));
  const WheelRows<double> r = values(placed);
  WheelForce force{r.depth, 0., 0., {}, 0.};
  if (!(r.depth > 0.)) {
    slopes = {};
    return force;
  }
  const double per_speed = per_rolling(speed);
  const Slip<Placed> slip = slip_of(c, placed, v, speed, radius, rail);
  const ContactForces<Placed> slopes_of = contact_forces(c, placed.depth, slip, per_speed);
  const ContactForces<double> f = values(slopes_of);
  force.normal = f.normal;
  force.across = f.across;
  force.creep_power =
      f.along * slip.along.value + f.across * slip.across.value + f.moment * slip.spin.value;
  generalise(r, f, force.generalised);
  find_slopes(c, r, slopes_of, per_speed, slopes);
  return force;
}

}  // namespace railstep
