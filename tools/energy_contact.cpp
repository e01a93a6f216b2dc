#include "energy_contact.h"

#include <algorithm>
#include <cmath>

#include "online/contact/ports.h"

namespace railstep {
namespace {

/// Where the forces act: of loads, and of wheels still without force.
int ports_of(const Model& model, StandingContacts& c, RailForce* port) {
  for (int i = 0; i < c.loads; ++i)
    port[i] = {model.load[i].kind, c.load[i].row.element, c.load[i].xi, c.load[i].force};
  for (int i = 0; i < c.wheels; ++i)
    port[c.loads + i] = {wheel_kind(model, i), c.contact[i].row.element, c.contact[i].xi, 0.};
  return c.loads + c.wheels;
}

/// Turns after which a negative residual no longer matters: each leaves |G| dP/dd of it, 1e-2.
constexpr int kTurns = 10;

/// Forces of the wheels by d + W f = d_free, W = G between wheels. Where G is below 0, which it may
/// be by itself, it acts through the force of the turn before.
void press(const Model& model, StandingContacts& c, RailForce* port, int ports) {
  double W[kMaxWheels * kMaxWheels], free[kMaxWheels], negative[kMaxWheels];
  PortLaw law[kMaxWheels];
  double force[kMaxWheels], d[kMaxWheels];
  for (int i = 0; i < c.wheels; ++i) {
    const bool on_rail = c.contact[i].on_rail;
    law[i] = {model.wheelset[i / 2].hertz[i % 2], 0., 0.};
    force[i] = 0.;
    free[i] =
        on_rail ? c.approach[i] + residual_displacement(model, port, ports, c.loads + i) : -1.;
    for (int j = 0; j < c.wheels; ++j) {
      const RailForce &at = port[c.loads + i], &other = port[c.loads + j];
      W[i * c.wheels + j] = !on_rail || !c.contact[j].on_rail ? 0.
                            : i == j                          ? residual_under(model, at)
                                                              : residual_between(model, other, at);
    }
    double& own = W[i * c.wheels + i];
    negative[i] = std::min(own, 0.);
    own = std::max(own, 0.);
  }
  for (int turn = 0; turn < kTurns; ++turn) {
    double shifted[kMaxWheels];
    for (int i = 0; i < c.wheels; ++i) shifted[i] = free[i] - negative[i] * force[i];
    static_cast<void>(solve_ports(c.wheels, W, law, shifted, force, d));  // as good as it gets
  }
  for (int i = 0; i < c.wheels; ++i) {
    port[c.loads + i].force = -force[i];
    const double depth = std::max(d[i], 0.);
    c.hertz += .4 * law[i].hertz * depth * depth * std::sqrt(depth);
  }
}

}  // namespace

StandingContacts standing_contacts(const Model& model, const State& state) {
  StandingContacts c{};
  c.loads = model.loads;
  c.wheels = wheel_count(model);
  const Configuration at{state.u, {state.u, state.v}};
  for (int i = 0; i < c.loads; ++i) c.load[i] = place(model, model.load[i], state.steps);
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    find_contacts(model, model.wheelset[b], at, c.contact + 2 * b);
  for (int i = 0; i < c.wheels; ++i) {
    c.approach[i] = c.contact[i].on_rail ? c.contact[i].penetration : 0.;
  }
  RailForce port[kMaxLoads + kMaxWheels];
  const int ports = ports_of(model, c, port);
  if (c.wheels > 0) press(model, c, port, ports);
  for (int i = 0; i < ports; ++i) {
    c.force[i] = port[i].force;
    const bool on_rail = i < c.loads ? c.load[i].on_rail : c.contact[i - c.loads].on_rail;
    c.moved[i] = on_rail ? residual_displacement(model, port, ports, i) : 0.;
    c.residual += .5 * c.force[i] * c.moved[i];
  }
  return c;
}

double residual_work(const StandingContacts& before, const StandingContacts& after) {
  double sum = 0.;
  for (int i = 0; i < before.loads + before.wheels; ++i) {
    if (i < before.loads)
      sum += .5 * (before.force[i] + after.force[i]) * (after.moved[i] - before.moved[i]);
    sum -= .5 * (before.force[i] * after.moved[i] - after.force[i] * before.moved[i]);
  }
  return sum;
}

}  // namespace railstep
