#include "online/contact/vehicle_response.h"

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

const VehicleModel& vehicle_of(const Model& model, ContactId wheel) noexcept {
  return model.vehicle[vehicle_wheel(model, wheel).vehicle];
}

/// Index of a wheel among those of its vehicle.
int among_own(const Model& model, ContactId wheel) noexcept {
  return among_vehicle_wheels(model, wheel) - vehicle_of(model, wheel).first_wheel;
}

DepthSpeed speed_of(const Model& model, double time, const State& s, const Workspace& w,
                    const Coupling& c, ContactId i) noexcept {
  const WheelContact& at = c.contact[i];
  const VehicleModel& v = vehicle_of(model, i);
  const Configuration located = located_on(model, s, w);
  double along = at.slope, missed = 0.;
  if (at.on_rail) {
    along += slope_under(model, at, located);
    missed = residual_before(model, s, c, i);
  }
  const double when = time - (1. - held_fraction(model)) * model.scheme.dt;
  const double passing = travelled(v.travel, when).speed * along;
  if (model.form == Form::condensed) {
    DepthSpeed speed = mean_speed(
        model.scheme, c.located[i] + at.irregularity + missed - lift_by(model, c, i, s.u));
    speed.before += passing;
    return speed;
  }
  double d_star = at.irregularity + missed - lift_by(model, c, i, w.u_star);
  double rate = -lift_by(model, c, i, w.v_star);
  if (at.on_rail) {
    d_star += rail_height(model, at.row, {w.u_star, {}});
    rate += rail_height(model, at.row, {w.v_star, {}});
  }
  return speed_at_end(model.scheme, d_star, passing + rate);
}

}  // namespace

void free_vehicles(const Model& model, double time, const State& s, Workspace& w) noexcept {
  for (std::int32_t b = 0; b < model.vehicles; ++b) {
    const VehicleModel& v = model.vehicle[b];
    double force[kMaxVehicleUnknowns] = {};
    move_freely(model, v, time, s, w, force, w.solved + v.first);
  }
}

void find_vehicle_laws(const Model& model, double time, const State& s, const Workspace& w,
                       Coupling& c) noexcept {
  for (ContactId i = tread_count(model); i < wheel_count(model); ++i) {
    const ContactModel& contact = vehicle_wheel(model, i).contact;
    c.law[i] = {contact.hertz, contact.stiffness, 0., contact.hertz == 0.};
    if (contact.damping == 0.) continue;
    add_damper(contact.damping, speed_of(model, time, s, w, c, i), c.law[i]);
  }
}

double vehicle_compliance(const Model& model, ContactId i, ContactId j) noexcept {
  if (vehicle_wheel(model, i).vehicle != vehicle_wheel(model, j).vehicle) return 0.;
  const VehicleModel& v = vehicle_of(model, i);
  return v.compliance[among_own(model, i) * v.wheels + among_own(model, j)];
}

double vehicle_offset(const Model& model, const State& s, const Coupling& c, ContactId i) noexcept {
  return (c.located[i] + c.contact[i].irregularity) -
         (1. - model.scheme.theta) * lift_by(model, c, i, s.u);
}

void move_vehicles(const Model& model, Workspace& w, const Coupling& c) noexcept {
  for (std::int32_t b = 0; b < model.vehicles; ++b) {
    const VehicleModel& v = model.vehicle[b];
    double* u = w.solved + v.first;
    for (int i = 0; i < v.wheels; ++i) {
      const double force = c.force[vehicle_contact(model, v.first_wheel + i)];
      for (int k = 0; k < v.size; ++k) u[k] += v.response[i * v.size + k] * force;
    }
  }
}

bool vehicle_impact_is_unresolved(const Model& model, const Coupling& c, const State& s,
                                  ContactId wheel) noexcept {
  const VehicleModel& v = vehicle_of(model, wheel);
  const double* row = row_of_wheel(model, wheel);
  const double hertz = vehicle_wheel(model, wheel).contact.hertz;
  const double time = static_cast<double>(s.steps) * model.scheme.dt;
  double speed = c.contact[wheel].slope * travelled(v.travel, time).speed, inverse_mass = 0.;
  for (int k = 0; k < v.size; ++k) {
    speed -= row[k] * s.v[v.first + k];
    inverse_mass += row[k] * row[k] / v.mass[k];
  }
  return hertz > 0. && impact_is_unresolved(hertz, inverse_mass, speed, model.scheme.dt);
}

}  // namespace railstep
