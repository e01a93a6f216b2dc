#include "online/contact/flange.h"

#include "online/contact/damper.h"
#include "online/contact/impact.h"
#include "online/contact/track_response.h"
#include "online/contact/vehicle_contact.h"

namespace railstep {

namespace {

/// Gap that forces cannot close within a step, beyond the present velocity, m: in 1 ms this would
/// take 1000 m/s^2.
constexpr double kInactiveGap = 1e-3;

/// Increase of a wheelset's distance from its rail at a contact by changes of its coordinates.
double lift(const WheelContact& at, const double* p, const double* from) noexcept {
  double sum = 0.;
  for (int k = 0; k < 6; ++k) sum += at.body_row[k] * (p[k] - (from == nullptr ? 0. : from[k]));
  return sum;
}

DepthSpeed speed_of(const Model& model, const State& s, const Workspace& w, const WheelContact& at,
                    const WheelsetModel& set) noexcept {
  const std::int32_t first = set.first;
  const double passing = at.slope * s.v[first], *located = w.scaled + first;
  if (model.form == Form::condensed) {
    DepthSpeed speed = mean_speed(model.scheme, at.penetration + lift(at, located, s.u + first));
    speed.before += passing;
    return speed;
  }
  const double moved = rail_height(model, at.row, {w.u_star, {}}) -
                       rail_height(model, at.row, located_on(model, s, w));
  const double d_star = at.penetration + moved - lift(at, w.u_star + first, located);
  const double rate =
      rail_height(model, at.row, {w.v_star, {}}) - lift(at, w.v_star + first, nullptr);
  return speed_at_end(model.scheme, d_star, passing + rate);
}

}  // namespace

void locate_flanges(const Model& model, const State& s, const Workspace& w, double later,
                    Coupling& c) noexcept {
  const Configuration located = located_on(model, s, w);
  for (std::int32_t f = 0; f < model.flanges; ++f) {
    const FlangeModel& flange = model.flange[f];
    const ContactId left = flange_contact(model, flange_number(f, 0));
    find_flanges(model, flange, located, c.contact + left,
                 later * s.v[model.wheelset[flange.wheelset].first]);
    for (ContactId i = left; i <= flange_contact(model, flange_number(f, 1)); ++i) {
      WheelContact& at = c.contact[i];
      at.inactive = at.on_rail && at.penetration < -kInactiveGap;
      if (at.inactive) at.on_rail = false;
      c.place[i].load_point = kNoLoadPoint;
    }
  }
}

void find_flange_laws(const Model& model, const State& s, const Workspace& w,
                      Coupling& c) noexcept {
  for (ContactId i = wheel_count(model); i < c.contacts; ++i) {
    const FlangeModel& flange = flange_of(model, i);
    c.law[i] = {flange.contact.hertz, flange.contact.stiffness, 0.};
    if (flange.contact.damping == 0. || !c.contact[i].on_rail) continue;
    add_damper(flange.contact.damping,
               speed_of(model, s, w, c.contact[i], model.wheelset[flange.wheelset]), c.law[i]);
  }
}

bool flange_impact_is_unresolved(const Model& model, const Coupling& c, const State& s,
                                 ContactId contact) noexcept {
  const FlangeModel& flange = flange_of(model, contact);
  const WheelsetModel& set = model.wheelset[flange.wheelset];
  const WheelContact& at = c.contact[contact];
  double inverse_mass = 0.;
  for (int k = 1; k < 5; ++k)  // x and yaw are guided
    inverse_mass += at.body_row[k] * at.body_row[k] / set.mass[k];
  const double speed = at.slope * s.v[set.first] - lift(at, s.v + set.first, nullptr);
  if (flange.contact.hertz > 0.)
    return impact_is_unresolved(flange.contact.hertz, inverse_mass, speed, model.scheme.dt);
  return spring_impact_is_unresolved(flange.contact.stiffness, inverse_mass, speed,
                                     model.scheme.dt);
}

}  // namespace railstep
