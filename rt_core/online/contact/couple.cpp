#include "online/contact/couple.h"

#include "online/contact/body_contact.h"
#include "online/contact/fixed_port_force.h"
#include "online/contact/guide.h"
#include "online/contact/mean_contact.h"
#include "online/contact/runner_coupling.h"
#include "online/contact/system_coupling.h"
#include "online/contact/track_compliance.h"
#include "online/contact/track_response.h"
#include "online/contact/vehicle_contact.h"
#include "online/track/moving_load.h"
#include "online/track/p_delta.h"

namespace railstep {

namespace {

/// Gap that forces cannot close within a step, beyond the present velocity, m: in 1 ms this would
/// take 1000 m/s^2.
constexpr double kInactiveGap = 1e-3;

/// Finds the contacts of a wheelset on its treads and flanges.
void locate_wheelset(const Model& model, std::int32_t b, const Configuration& located, double ahead,
                     Coupling& c) noexcept {
  const WheelsetContacts own = contacts_of(model, b);
  find_contacts(model, b, located, c.contact + own.at[0], ahead);
  if (own.pair >= 0)
    find_flanges(model, model.flange[own.pair], located, c.contact + own.at[2], ahead);
  for (int n = 0; n < own.count; ++n) {
    WheelContact& at = c.contact[own.at[n]];
    at.inactive = is_flange(model, own.at[n]) && at.on_rail && at.penetration < -kInactiveGap;
    if (at.inactive) at.on_rail = false;
  }
}

/// Finds the contacts where the forces of the step act: at its end, on u + dt v of bodies and
/// banded lines. If forces are held it is the middle of the step, with condensed lines as they are
/// at the start (their fastest rates are far above 1/dt).
void locate_contacts(const Model& model, const Stage& stage, const State& s, Workspace& w,
                     Coupling& c) noexcept {
  const double ahead = (model.form == Form::condensed ? .5 : 1.) * stage.span;
  // Irregularities are taken where the penetration is taken; for a mean, in the middle.
  const double later = model.scheme.mean != 0 ? 0. : model.scheme.theta * stage.span - ahead;
#pragma omp simd
  for (std::int32_t i = modal_unknowns(model); i < model.unknowns; ++i)
    w.scaled[i] = s.u[i] + ahead * s.v[i];
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    locate_wheelset(model, b, located_on(model, s, w), later * s.v[model.wheelset[b].first], c);
  place_vehicle_wheels(model, stage.step, stage.before + (stage.span - ahead), c.contact, later);
  for (const ContactId i : contacts(c))
    c.place[i] = {model, model.contact[i].load_point, c.contact[i].row.element, c.contact[i].xi,
                  0.};
  locate_wheel_seats(model, stage, s, w, c);
}

/// Coupling::rail_depth of all contacts. The rails must have been located.
void find_rail_depths(const Model& model, const Workspace& w, Coupling& c) noexcept {
  for (const ContactId i : contacts(c))
    c.rail_depth[i] = is_upright(model, i)
                          ? c.located[i] + c.contact[i].irregularity
                          : c.contact[i].penetration + lift_by(model, c, i, w.scaled);
}

/// Residual displacement of the rail under each wheel by the loads and the external wheels.
void find_residual_by_loads(const Model& model, const Stage& stage, const ExternalContact* external,
                            Coupling& c) noexcept {
  for (int i = 0; i < c.rows; ++i) c.by_loads[i] = 0.;
  for (std::int32_t n = 0; n < model.external_wheels; ++n)
    for (int i = 0; i < c.rows && external[n].on_rail; ++i)
      c.by_loads[i] += external[n].force[2] * residual_between(model, external[n].port, c.place[i]);
  for (std::int32_t l = 0; l < model.loads; ++l) {
    const PlacedLoad load = place(model, model.load[l], stage.step, stage.before);
    if (!load.on_rail) continue;
    const RailForce at{model, model.load[l].load_point, load.row.element, load.xi, load.force};
    for (int i = 0; i < c.rows; ++i)
      c.by_loads[i] += load.force * residual_between(model, at, c.place[i]);
  }
}

/// W between all rows: through the lines, the bodies of contacts and the residual flexibility.
void compliance(const Model& model, const Workspace& w, Coupling& c) noexcept {
  track_compliance(model, w, c);
  for (int i = 0; i < c.rows; ++i)
    for (int j = 0; j <= i; ++j) {
      // Bodies of runners are coordinates of their own.
      const bool of_contacts = i < c.contacts;
      const double body = of_contacts ? body_compliance(model, c, {i}, {j}) : 0.;
      double sum = 0.;
      if (is_on_rail(c, i) && is_on_rail(c, j))
        sum = model.scheme.theta * (c.W[i * c.ports + j] + body) +
              (i != j        ? residual_between(model, c.place[j], c.place[i])
               : of_contacts ? residual_under(model, c.place[i])
                             : 0.);
      else if (of_contacts && stands(c.contact[i]) && stands(c.contact[j]))
        sum = model.scheme.theta * body;
      c.W[i * c.ports + j] = c.W[j * c.ports + i] = sum;
    }
  add_seat_flexibility(model, c);
}

/// Penetration by the track alone: the located one, plus the track's motion since then.
void track_penetration(const Model& model, const State& s, const Workspace& w,
                       Coupling& c) noexcept {
  find_track_motion(model, w, c);
  for (const ContactId i : contacts(c)) {
    // Off the rail: far away.
    c.track_free[i] = c.contact[i].inactive ? c.contact[i].penetration : -1.;
    if (c.contact[i].on_rail)
      c.track_free[i] = model.scheme.theta * c.moved[i] + c.by_loads[i];
    else if (c.contact[i].on_ground)
      c.track_free[i] = 0.;
    if (stands(c.contact[i]))
      c.track_free[i] += c.rail_depth[i] - (1. - model.scheme.theta) * lift_by(model, c, i, s.u);
  }
  for (int i = c.contacts; i < c.rows; ++i) {
    c.track_free[i] = 0.;
    if (is_on_rail(c, i))
      c.track_free[i] = (c.located[i] + model.scheme.theta * c.moved[i]) +
                        (c.by_loads[i] + c.seat[i - c.contacts].rise);
  }
}

/// Result of one solve of all ports, by either method.
struct Solved {
  Status status;  // cap_reached or contact_ill_posed
  int iterations;
};

Status status_of(PortStatus met) noexcept {
  switch (met) {
    case PortStatus::converged:
      return Status::ok;
    case PortStatus::cap_reached:
      return Status::cap_reached;
    case PortStatus::indefinite:
    case PortStatus::bad_input:
      break;
  }
  return Status::contact_ill_posed;
}

/// Penetration of a port without the forces of all.
double free_depth(const Model& model, const Workspace& w, const Coupling& c, int port) noexcept {
  if (port >= c.contacts || !stands(c.contact[port])) return c.track_free[port];
  return c.track_free[port] - model.scheme.theta * lift_by(model, c, {port}, w.solved);
}

/// Ports for given multipliers.
/// @param runners  null: there are none on this track
Solved solve(const Model& model, const Workspace& w, Coupling& c,
             CoupledRunners* runners) noexcept {
  if (runners != nullptr) {
    for (int i = 0; i < runners->scalars; ++i)
      runners->z_free[i] = free_depth(model, w, c, port_of(c, i));
    const NewtonResult met = solve_coupled_runners(model, w, c, *runners);
    return {status_of(met.status), met.iterations};
  }
  for (int i = 0; i < c.ports; ++i) c.penetration[i] = free_depth(model, w, c, i);
  const PortResult met = solve_ports(c.ports, c.W, c.law, c.penetration, c.force, c.penetration);
  return {status_of(met.status), met.iterations};
}

/// The guides' augmented Lagrangian around the contacts, at most the largest cap of the wheelsets.
void solve_coupled(const Model& model, const Stage& stage, State& s, Workspace& w, Coupling& c,
                   CoupledRunners* runners, CoupleResult& result) noexcept {
  const std::int32_t cap = guide_iterations(model);
  bool settled = false;
  Status met = Status::ok;
  for (std::int32_t iteration = 0; iteration < cap && !settled; ++iteration) {
    take_multipliers(model, s, c, w);
    const Solved ports = solve(model, w, c, runners);
    met = ports.status;
    if (ports.iterations > result.iterations) result.iterations = ports.iterations;
    result.violation = 0.;
    settled = correct_multipliers(model, stage, s, w, c, result.violation);
    if (iteration + 1 > result.iterations) result.iterations = iteration + 1;
  }
  result.status = result.status | met;
  if (!settled) result.status = result.status | Status::cap_reached;
}

/// The same, and a system of bodies with them.
void solve_all(const Model& model, const Stage& stage, State& s, Workspace& w, Coupling& c,
               CoupledRunners* runners, CoupleResult& result) noexcept {
  bool settled = false;
  for (int pass = 0; pass < kSystemPasses && !settled; ++pass) {
    solve_coupled(model, stage, s, w, c, runners, result);
    settled = !couples_system(model) || settle_system(model, s, w, c, runners, result.system);
  }
  if (!settled) result.status = result.status | Status::cap_reached;
}

/// The same on a track with runners. By itself, so that they take no stack where there are none.
[[gnu::noinline]] void solve_with_runners(const Model& model, const Stage& stage, State& s,
                                          Workspace& w, Coupling& c,
                                          CoupleResult& result) noexcept {
  CoupledRunners runners;
  couple_runners(model, stage, s, w, c, runners);
  solve_all(model, stage, s, w, c, &runners, result);
  result.status = result.status | move_coupled_runners(model, c, runners, s, w);
}

void publish_wheels(const Model& model, const Coupling& c, State& state,
                    CoupleResult& result) noexcept {
  for (const ContactId i : contacts(c)) {
    const WheelContact& at = c.contact[i];
    if (state.contact_force[i] <= 0. && c.force[i] > 0. && impact_is_unresolved(model, c, state, i))
      result.status = result.status | Status::contact_unresolved;
    state.contact_force[i] = c.force[i];
    result.gap[i] = -c.penetration[i];
    result.x[i] = at.x;
    result.on_rail[i] = at.on_rail;
    if (!stands(at) && !at.inactive) result.status = result.status | Status::off_rail;
    if (at.roll * at.roll > kLargeRollSquared) result.status = result.status | Status::large_turn;
    if (at.cap_reached) result.status = result.status | Status::cap_reached;
    if (c.force[i] <= 0. && !c.law[i].bilateral && !is_flange(model, i))
      result.status = result.status | Status::contact_lost;
  }
}

}  // namespace

CoupleResult couple(const Model& model, const Stage& stage, const ExternalContact* external,
                    State& state, Workspace& w) noexcept {
  CoupleResult result{};
  Coupling c;
  c.contacts = contact_count(model);
  c.rows = track_row_count(model);
  c.ports = port_count(model);
  c.mirrored = c.rows > c.contacts && seats_mirror(model);
  c.of_set = !c.mirrored ? 2 * kWheelSeatRows : kWheelSeatRows + (has_levers(model) ? 2 : 0);
  c.bases = c.contacts + c.of_set * ((c.rows - c.contacts) / (2 * kWheelSeatRows));
  c.shapes_levers = model.fixed.count > 0 || couples_system(model);
  c.W = w.compliance;
  const double time = time_of(model.scheme, stage) - (1. - held_fraction(model)) * stage.span;
  locate_contacts(model, stage, state, w, c);
  find_acting(model, c);
  respond(model, state, w, c);
  if (c.mirrored) lean_wheel_seats(model, c);
  find_rail_depths(model, w, c);
  find_residual_by_loads(model, stage, external, c);
  free_wheelsets(model, stage, time, state, w, c);
  free_vehicles(model, time, state, w);
  find_contact_laws(model, time, state, w, c);
  compliance(model, w, c);
  track_penetration(model, state, w, c);
  if (model.scheme.mean != 0) find_means(model, state, c);
  if (model.fixed.count > 0) couple_fixed_ports(model, state, w, c);
  for (const ContactId i : contacts(c)) c.force[i] = state.contact_force[i];
  if (couples_system(model)) couple_system(model, state, w, c, result.system);
  if (c.rows > c.contacts)
    solve_with_runners(model, stage, state, w, c, result);
  else
    solve_all(model, stage, state, w, c, nullptr, result);
  move_track(model, w, c);
  move_bodies(model, c, w);
  if (model.fixed.count > 0) apply_fixed_port_forces(model, c, state, w);
  finish_track(model, w);
  publish_wheels(model, c, state, result);
  return result;
}

}  // namespace railstep
