#include "online/contact/body_contact.h"

#include "online/contact/damper.h"
#include "online/contact/impact.h"
#include "online/contact/mean_contact.h"
#include "online/contact/track_response.h"
#include "online/contact/vehicle_contact.h"
#include "online/math/dense.h"
#include "online/runner/suspended.h"
#include "online/track/travel.h"

namespace railstep {

namespace {

/// Rate of the penetration by motion along the rail, m/s.
double passing(const Model& model, double time, const State& s, const Workspace& w,
               const Coupling& c, ContactId i) noexcept {
  const WheelContact& at = c.contact[i];
  const SuspendedModel& own = bodies_of(model, i);
  if (!is_upright(model, i)) return at.slope * s.v[own.first];
  const double rail = at.on_rail ? slope_under(model, at, located_on(model, s, w)) : 0.;
  return travelled(own.travel, time).speed * (at.slope + rail);
}

DepthSpeed speed_of(const Model& model, double time, const State& s, const Workspace& w,
                    const Coupling& c, ContactId i) noexcept {
  const WheelContact& at = c.contact[i];
  const double along = passing(model, time, s, w, c, i);
  const double depth = c.rail_depth[i] + (at.on_rail ? residual_before(model, s, c, i) : 0.);
  if (model.form == Form::condensed) {
    DepthSpeed speed = mean_speed(model.scheme, depth - lift_by(model, c, i, s.u));
    speed.before += along;
    return speed;
  }
  double d_star = depth - lift_by(model, c, i, w.u_star), rate = -lift_by(model, c, i, w.v_star);
  if (at.on_rail) {
    d_star += motion(model, at.row, {w.u_star, {}}) - c.located[i];
    rate += motion(model, at.row, {w.v_star, {}});
  }
  return speed_at_end(model.scheme, d_star, along + rate);
}

/// Inverse of the mass at the lift `row` of a wheelset or vehicle, against the lift `other`; a
/// wheelset's guide holds its x and yaw.
double inverse_mass(const Model& model, ContactId i, const double* row,
                    const double* other) noexcept {
  const SuspendedModel& own = bodies_of(model, i);
  double sum = 0.;
  for (int k = 0; k < own.size; ++k)
    if (is_upright(model, i) || (k != kGuided[0] && k != kGuided[1]))
      sum += row[k] * other[k] / own.mass[k];
  return sum;
}

}  // namespace

void free_vehicles(const Model& model, double time, const State& s, Workspace& w) noexcept {
  for (std::int32_t b = 0; b < model.vehicles; ++b) {
    const SuspendedModel& v = model.vehicle[b];
    double force[kMaxVehicleUnknowns] = {};
    move_freely(model, v, time, s, w, nullptr, force, w.solved + v.first);
  }
}

void find_contact_laws(const Model& model, double time, const State& s, const Workspace& w,
                       Coupling& c) noexcept {
  for (const ContactId i : contacts(c)) {
    const ContactLaw& law = model.contact[i].law;
    const bool pulls = is_upright(model, i) && law.hertz == 0.;
    c.law[i] = {law.hertz, law.stiffness, 0., pulls};
    if (law.damping == 0. || !stands(c.contact[i])) continue;
    add_damper(law.damping, speed_of(model, time, s, w, c, i), c.law[i]);
  }
}

double body_compliance(const Model& model, const Coupling& c, ContactId i, ContactId j) noexcept {
  const SuspendedModel& own = bodies_of(model, i);
  if (&own != &bodies_of(model, j)) return 0.;
  const double* const other = lift_row(model, c, j);
  double sum = 0.;
  for (int k = 0; k < own.size; ++k) sum += moved_by_force(model, c, i, k) * other[k];
  return sum;
}

void move_bodies(const Model& model, const Coupling& c, Workspace& w) noexcept {
  double* const change = w.scaled;
  const auto for_each = [&](const auto& visit) noexcept {
    for (const ContactId i : contacts(c)) {
      const SuspendedModel& own = bodies_of(model, i);
      for (int k = 0; k < own.size; ++k) visit(i, k, own.first + k);
    }
  };
  for_each([&](ContactId, int, std::int32_t at) noexcept { change[at] = 0.; });
  for_each([&](ContactId i, int k, std::int32_t at) noexcept {
    change[at] += moved_by_force(model, c, i, k) * c.force[i];
  });
  // Added as one, so that bodies whose forces are balanced keep their place to the last bit.
  for_each([&](ContactId, int, std::int32_t at) noexcept {
    w.solved[at] += change[at];
    change[at] = 0.;
  });
}

bool impact_is_unresolved(const Model& model, const Coupling& c, const State& s,
                          ContactId i) noexcept {
  const ContactModel& contact = model.contact[i];
  const SuspendedModel& own = bodies_of(model, i);
  const double* const row = lift_row(model, c, i);
  const double time = static_cast<double>(s.steps) * model.scheme.dt, dt = model.scheme.dt;
  const double ahead = is_upright(model, i) ? travelled(own.travel, time).speed : s.v[own.first];
  const double speed = c.contact[i].slope * ahead - lift_by(model, c, i, s.v);
  const double alone = inverse_mass(model, i, row, row);
  double inverse = alone;
  if (contact.kind == ContactKind::tread) {
    const double together = alone + inverse_mass(model, i, row, lift_row(model, c, other_tread(i)));
    inverse = alone > together ? alone : together;
  }
  if (contact.law.hertz > 0.) return impact_is_unresolved(contact.law.hertz, inverse, speed, dt);
  return is_flange(model, i) &&
         spring_impact_is_unresolved(contact.law.stiffness, inverse, speed, dt);
}

}  // namespace railstep
