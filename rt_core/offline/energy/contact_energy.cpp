#include "offline/energy/contact_energy.h"

#include <algorithm>
#include <cmath>

#include "online/contact/ports.h"
#include "online/contact/vehicle_contact.h"
#include "online/model/progress.h"

namespace railstep {
namespace {

/// Places of the forces: of loads, and of wheels, whose forces are still 0.
int ports_of(const Model& model, StandingContacts& c, RailForce* acting) {
  for (int i = 0; i < c.loads; ++i)
    acting[i] = {model, model.load[i].load_point, c.load[i].row.element, c.load[i].xi,
                 c.load[i].force};
  for (const ContactId i : contacts(c))
    acting[c.loads + i] = {model, model.contact[i].load_point, c.contact[i].row.element,
                           c.contact[i].xi, 0.};
  return c.loads + c.contacts;
}

/// Iterations for a negative residual: each leaves |G| dP/dd = 1e-2 of the last error.
constexpr int kIterations = 10;

bool stands(const WheelContact& at) { return at.on_rail || at.on_ground; }

/// A linear contact is bilateral. Its force is known, and contains the damper's part, which the
/// penetration does not show.
bool is_linear(const Model& model, ContactId wheel) {
  return is_upright(model, wheel) && model.contact[wheel].law.hertz == 0.;
}
/// Whether residual flexibility changes the depth of a contact.
bool takes_residual(const Model& model, ContactId wheel) {
  return !is_flange(model, wheel) && !is_linear(model, wheel);
}
double hertz_of(const Model& model, ContactId wheel) {
  return takes_residual(model, wheel) ? model.contact[wheel].law.hertz
                                      : 1.;  // not used: such a port stays open
}

/// Energy in a linear contact. Without a damper it follows from the force, which is more accurate
/// than the small penetration of a stiff contact.
double linear_energy(const ContactLaw& contact, double force, double depth) {
  return contact.damping == 0. ? .5 * force * force / contact.stiffness
                               : .5 * contact.stiffness * depth * depth;
}

/// Forces of the wheels by d + W f = d_free, W = G between wheels. If G is below 0, which it may be
/// without the lines, it acts through the force of the iteration before.
void solve_forces(const Model& model, StandingContacts& c, RailForce* acting, int ports) {
  double W[kMaxWheels * kMaxWheels], free[kMaxWheels], negative[kMaxWheels];
  PortLaw law[kMaxWheels];
  double force[kMaxWheels], d[kMaxWheels];
  for (const ContactId i : contacts(c)) {
    const bool on_rail = c.contact[i].on_rail && takes_residual(model, i);
    law[i] = {hertz_of(model, i), 0., 0.};
    force[i] = 0.;
    free[i] =
        on_rail ? c.approach[i] + residual_displacement(model, acting, ports, c.loads + i) : -1.;
    if (c.contact[i].on_ground && takes_residual(model, i)) free[i] = c.approach[i];
    for (const ContactId j : contacts(c)) {
      const RailForce &at = acting[c.loads + i], &other = acting[c.loads + j];
      const bool coupled = on_rail && c.contact[j].on_rail && takes_residual(model, j);
      W[i * c.contacts + j] = !coupled ? 0.
                              : i == j ? residual_under(model, at)
                                       : residual_between(model, other, at);
    }
    double& own = W[i * c.contacts + i];
    negative[i] = std::min(own, 0.);
    own = std::max(own, 0.);
  }
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    double shifted[kMaxWheels];
    for (const ContactId i : contacts(c)) shifted[i] = free[i] - negative[i] * force[i];
    static_cast<void>(solve_ports(c.contacts, W, law, shifted, force, d));  // as good as it gets
  }
  for (const ContactId i : contacts(c)) {
    if (!takes_residual(model, i)) continue;
    acting[c.loads + i].force = c.contact[i].on_rail ? -force[i] : 0.;
    const double depth = std::max(d[i], 0.);
    c.hertz += .4 * law[i].hertz * depth * depth * std::sqrt(depth);
  }
}

double flange_energy(const ContactLaw& contact, double depth) {
  const double d = std::max(depth, 0.);
  return contact.hertz > 0. ? .4 * contact.hertz * d * d * std::sqrt(d)
                            : .5 * contact.stiffness * d * d;
}

/// Penetrations of all contacts under known forces, and the energy of contacts without part in G.
void find_depths(const Model& model, const State& state, StandingContacts& c) {
  for (const ContactId i : contacts(c)) {
    c.depth[i] = c.approach[i] + c.moved[c.loads + i];
    if (is_linear(model, i))
      c.hertz += linear_energy(model.contact[i].law, state.contact_force[i], c.depth[i]);
    if (is_flange(model, i)) c.hertz += flange_energy(model.contact[i].law, c.depth[i]);
  }
}

}  // namespace

StandingContacts standing_contacts(const Model& model, const State& state) {
  StandingContacts c{};
  c.loads = model.loads;
  c.contacts = contact_count(model);
  const Configuration at{state.u, {state.u, state.v}, track_offset(model, state.steps)};
  for (int i = 0; i < c.loads; ++i) c.load[i] = place(model, model.load[i], state.steps);
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    find_contacts(model, b, at, c.contact + tread_of(b, 0));
  for (std::int32_t f = 0; f < model.flanges; ++f)
    find_flanges(model, model.flange[f], at,
                 c.contact + flange_contact(model, flange_number(f, 0)));
  find_vehicle_contacts(model, state.steps, 0., at, c.contact);
  for (const ContactId i : contacts(c))
    c.approach[i] = stands(c.contact[i]) ? c.contact[i].penetration : 0.;
  RailForce acting[kMaxRailForces];
  const int ports = ports_of(model, c, acting);
  for (const ContactId i : contacts(c))
    if (is_linear(model, i) && c.contact[i].on_rail)
      acting[c.loads + i].force = -state.contact_force[i];
  if (c.contacts > 0) solve_forces(model, c, acting, ports);
  for (int i = 0; i < ports; ++i) {
    c.force[i] = acting[i].force;
    const bool on_rail = i < c.loads ? c.load[i].on_rail : c.contact[i - c.loads].on_rail;
    c.moved[i] = on_rail ? residual_displacement(model, acting, ports, i) : 0.;
    c.residual += .5 * c.force[i] * c.moved[i];
  }
  find_depths(model, state, c);
  return c;
}

double contact_dissipation(const Model& model, const StandingContacts& before,
                           const StandingContacts& after, const double* mean_force) {
  const bool held = model.form == Form::condensed;
  const double late = held ? model.scheme.theta : .5;
  double sum = 0.;
  for (const ContactId i : contacts(model)) {
    if (i < tread_count(model)) continue;
    const bool one_sided = is_flange(model, i);
    const ContactLaw& contact = model.contact[i].law;
    if (contact.damping == 0.) continue;
    const double d0 = before.depth[i], d1 = after.depth[i];
    const auto spring = [&](double d) {
      return contact.stiffness * (one_sided ? std::max(d, 0.) : d);
    };
    const double kept =
        held ? spring(late * d1 + (1. - late) * d0) : late * (spring(d0) + spring(d1));
    sum += (mean_force[i] - kept) * (d1 - d0);
  }
  return sum;
}

double residual_work(const StandingContacts& before, const StandingContacts& after) {
  double sum = 0.;
  for (int i = 0; i < before.loads + before.contacts; ++i) {
    if (i < before.loads)
      sum += .5 * (before.force[i] + after.force[i]) * (after.moved[i] - before.moved[i]);
    sum -= .5 * (before.force[i] * after.moved[i] - after.force[i] * before.moved[i]);
  }
  return sum;
}

}  // namespace railstep
