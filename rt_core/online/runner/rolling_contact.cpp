#include "online/runner/rolling_contact.h"

namespace railstep {

void fill_rates_and_spread(const WheelRows<double>& r, const ContactCreep& creep,
                           ContactSlopes& slopes) noexcept {
  const double pressed[6] = {0., r.n_y, r.n_z, r.normal_roll, 0., r.normal_yaw};
  const double along[6] = {1., 0., 0., r.along_roll, r.along_spin, r.along_yaw};
  const double across[6] = {0., r.n_z, -r.n_y, r.across_roll, r.across_spin, r.across_yaw};
  const double spin[6] = {0., 0., 0., r.spin_roll, r.spin_spin, r.n_z};
  const double *const x = creep.by_slip[0], *const y = creep.by_slip[1];
  for (int k = 0; k < 6; ++k) {
    slopes.by_rate[0][k] = 0.;
    slopes.by_rate[1][k] = (x[0] * along[k] + x[1] * across[k]) + x[2] * spin[k];
    slopes.by_rate[2][k] = (y[0] * along[k] + y[1] * across[k]) + y[2] * spin[k];
    slopes.spread[k][0] = pressed[k];
    slopes.spread[k][1] = along[k];
    slopes.spread[k][2] = across[k];
  }
  const double section[3] = {-r.normal_section, 0., r.across_section};
  const double turned[3] = {0., x[1] * r.across_section, y[1] * r.across_section};
  for (int k = 0; k < 3; ++k) {
    slopes.section[k] = section[k];
    slopes.by_section_rate[k] = turned[k];
  }
}

namespace {

WheelRows<double> values(const WheelRows<Placed>& r) noexcept {
  return {r.depth.value,       r.n_y.value,         r.n_z.value,        r.normal_roll.value,
          r.normal_yaw.value,  r.along_roll.value,  r.along_spin.value, r.along_yaw.value,
          r.across_roll.value, r.across_spin.value, r.across_yaw.value, r.spin_roll.value,
          r.spin_spin.value,   r.normal_section,    r.across_section};
}

/// Derivatives of a creep force over kPlaced.
double by_motion(const Slip<Placed>& slip, const Placed& normal, const double* by_slip,
                 double by_normal, int m) noexcept {
  return (by_slip[0] * slip.along.slope[m] + by_slip[1] * slip.across.slope[m]) +
         (by_slip[2] * slip.spin.slope[m] + by_normal * normal.slope[m]);
}

void find_slopes(const WheelRows<double>& r, const Slip<Placed>& slip, const Placed& normal,
                 const ContactCreep& creep, ContactSlopes& slopes) noexcept {
  fill_rates_and_spread(r, creep, slopes);
  for (double& by : slopes.by_section) by = 0.;
  for (int m = 0; m < 4; ++m) {
    slopes.by_motion[0][m] = normal.slope[m];
    for (int k = 0; k < 2; ++k)
      slopes.by_motion[1 + k][m] = by_motion(slip, normal, creep.by_slip[k], creep.by_normal[k], m);
  }
}

}  // namespace

WheelForce wheel_force(const RollingContact& c, double radius, double side, const Rolling& rolling,
                       const double* u, const double* v, const RailRate& rail,
                       ContactSlopes& slopes) noexcept {
  const WheelRows<Placed> placed =
      wheel_rows(c, radius, side, Placed::along(0, u[1]), Placed::along(1, u[2]),
                 Placed::along(2, u[3]), Placed::along(3, u[5]));
  const WheelRows<double> r = values(placed);
  if (!(r.depth > 0.)) {
    slopes = {};
    return {r.depth, 0., 0., {}, 0., false, {}};
  }
  const Slip<Placed> slip = slip_of(placed, v, rolling.frame, radius, rail);
  const Slip<double> slips{slip.along.value, slip.across.value, slip.spin.value};
  const Placed normal = normal_force(c, placed.depth);
  const ContactCreep creep =
      creep_on_rail(c.creep, c.creep.patch, side, {r.depth, normal.value}, slips, rolling);
  find_slopes(r, slip, normal, creep, slopes);
  return wheel_force(r, normal.value, slips, rolling, creep);
}

}  // namespace railstep
