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

DepthSpeed speed_of(const Model& model, const State& s, const Workspace& w, const Coupling& c,
                    ContactId i) noexcept {
  const WheelContact& at = c.contact[i];
  const double passing = at.slope * s.v[bodies_of(model, i).first];
  const double located = at.penetration + lift_by(model, c, i, w.scaled);
  if (model.form == Form::condensed) {
    DepthSpeed speed = mean_speed(model.scheme, located - lift_by(model, c, i, s.u));
    speed.before += passing;
    return speed;
  }
  const double moved = rail_height(model, at.row, {w.u_star, {}}) -
                       rail_height(model, at.row, located_on(model, s, w));
  const double d_star = (located + moved) - lift_by(model, c, i, w.u_star);
  const double rate = rail_height(model, at.row, {w.v_star, {}}) - lift_by(model, c, i, w.v_star);
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
    add_damper(flange.contact.damping, speed_of(model, s, w, c, i), c.law[i]);
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
  const double speed = at.slope * s.v[set.first] - lift_by(model, c, contact, s.v);
  if (flange.contact.hertz > 0.)
    return impact_is_unresolved(flange.contact.hertz, inverse_mass, speed, model.scheme.dt);
  return spring_impact_is_unresolved(flange.contact.stiffness, inverse_mass, speed,
                                     model.scheme.dt);
}

}  // namespace railstep
