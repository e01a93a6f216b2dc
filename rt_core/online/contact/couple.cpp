#include "online/contact/couple.h"

#include "online/contact/fixed_port_force.h"
#include "online/contact/flange.h"
#include "online/contact/mean_contact.h"
#include "online/contact/runner_coupling.h"
#include "online/contact/system_coupling.h"
#include "online/contact/track_compliance.h"
#include "online/contact/track_response.h"
#include "online/contact/vehicle_contact.h"
#include "online/contact/vehicle_response.h"
#include "online/contact/wheelset.h"
#include "online/track/moving_load.h"
#include "online/track/p_delta.h"

namespace railstep {

namespace {

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
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    const WheelsetModel& set = model.wheelset[b];
    find_contacts(model, set, located_on(model, s, w), c.contact + tread_of(b, 0),
                  later * s.v[set.first]);
    for (int side = 0; side < 2; ++side) {
      const ContactId i = tread_of(b, side);
      c.law[i] = {set.hertz[side], 0., 0.};
      c.place[i] = {model, set.load_point[side], c.contact[i].row.element, c.contact[i].xi, 0.};
    }
  }
  locate_flanges(model, s, w, later, c);
  for (std::int32_t v = 0; v < model.vehicles; ++v)
    place_vehicle_wheels(model, model.vehicle[v], stage.step, stage.before + (stage.span - ahead),
                         c.contact, later);
  for (ContactId i = tread_count(model); i < wheel_count(model); ++i)
    c.place[i] = {model, load_point_of(model, i), c.contact[i].row.element, c.contact[i].xi, 0.};
  locate_wheel_seats(model, stage, s, w, c);
}

/// Whether there is a rail or ground under a wheel.
bool stands(const WheelContact& at) noexcept { return at.on_rail || at.on_ground; }

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

/// Change of the approach of wheel i by a unit force at wheel j, through the body that carries
/// both.
double body_compliance(const Model& model, const Coupling& c, ContactId i, ContactId j) noexcept {
  if (is_of_wheelset(model, i) != is_of_wheelset(model, j)) return 0.;
  return is_of_wheelset(model, i) ? wheelset_compliance(model, c, i, j)
                                  : vehicle_compliance(model, i, j);
}

/// W between all rows: through the lines, the bodies of contacts and the residual flexibility.
void compliance(const Model& model, const Workspace& w, Coupling& c) noexcept {
  track_compliance(model, w, c);
  for (int i = 0; i < c.rows; ++i)
    for (int j = 0; j <= i; ++j) {
      // Bodies of runners are coordinates of their own.
      const bool of_contacts = i < c.contacts;
      const double body = of_contacts ? body_compliance(model, c, i, j) : 0.;
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
  for (ContactId i = 0; i < c.contacts; ++i) {
    // Off the rail: far away.
    c.track_free[i] = c.contact[i].inactive ? c.contact[i].penetration : -1.;
    if (c.contact[i].on_rail)
      c.track_free[i] = model.scheme.theta * c.moved[i] + c.by_loads[i];
    else if (c.contact[i].on_ground)
      c.track_free[i] = 0.;
    if (stands(c.contact[i]))
      c.track_free[i] += is_of_wheelset(model, i) ? wheelset_offset(model, s, w, c, i)
                                                  : vehicle_offset(model, s, c, i);
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
double free_depth(const Model& model, const State& s, const Workspace& w, const Coupling& c,
                  int port) noexcept {
  if (port >= c.contacts || !stands(c.contact[port])) return c.track_free[port];
  return c.track_free[port] - model.scheme.theta * (is_of_wheelset(model, port)
                                                        ? free_lift(model, s, c, port)
                                                        : lift_by(model, c, port, w.solved));
}

/// Ports for given multipliers.
/// @param runners  null: there are none on this track
Solved solve(const Model& model, const State& s, const Workspace& w, Coupling& c,
             CoupledRunners* runners) noexcept {
  if (runners != nullptr) {
    for (int i = 0; i < runners->scalars; ++i)
      runners->z_free[i] = free_depth(model, s, w, c, port_of(c, i));
    const NewtonResult met = solve_coupled_runners(model, w, c, *runners);
    return {status_of(met.status), met.iterations};
  }
  double d_free[kPorts];
  for (int i = 0; i < c.ports; ++i) d_free[i] = free_depth(model, s, w, c, i);
  const PortResult met = solve_ports(c.ports, c.W, c.law, d_free, c.force, c.penetration);
  return {status_of(met.status), met.iterations};
}

/// The guides' augmented Lagrangian around the contacts, at most the largest cap of the wheelsets.
void solve_coupled(const Model& model, const Stage& stage, State& s, Workspace& w, Coupling& c,
                   CoupledRunners* runners, CoupleResult& result) noexcept {
  const std::int32_t cap = guide_iterations(model);
  bool settled = false;
  Status met = Status::ok;
  for (std::int32_t iteration = 0; iteration < cap && !settled; ++iteration) {
    const Solved ports = solve(model, s, w, c, runners);
    met = ports.status;
    if (ports.iterations > result.iterations) result.iterations = ports.iterations;
    result.violation = 0.;
    settled = move_wheelsets(model, stage, s, w, c, result.violation);
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

bool impact_is_unresolved_at(const Model& model, const Coupling& c, const State& s,
                             ContactId i) noexcept {
  if (is_flange(model, i)) return flange_impact_is_unresolved(model, c, s, i);
  return is_of_wheelset(model, i) ? tread_impact_is_unresolved(model, c, s, i)
                                  : vehicle_impact_is_unresolved(model, c, s, i);
}

void publish_wheels(const Model& model, const Coupling& c, State& state,
                    CoupleResult& result) noexcept {
  for (ContactId i = 0; i < c.contacts; ++i) {
    const WheelContact& at = c.contact[i];
    if (state.contact_force[i] <= 0. && c.force[i] > 0. &&
        impact_is_unresolved_at(model, c, state, i))
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
  const double time = time_of(model.scheme, stage);
  locate_contacts(model, stage, state, w, c);
  find_acting(model, c);
  respond(model, state, w, c);
  if (c.mirrored) lean_wheel_seats(model, c);
  find_residual_by_loads(model, stage, external, c);
  free_wheelsets(model, stage, state, w, c);
  free_vehicles(model, time, state, w);
  find_vehicle_laws(model, time, state, w, c);
  find_flange_laws(model, state, w, c);
  compliance(model, w, c);
  track_penetration(model, state, w, c);
  if (model.scheme.mean != 0) find_means(model, state, c);
  if (model.fixed.count > 0) couple_fixed_ports(model, state, w, c);
  for (ContactId i = 0; i < c.contacts; ++i) c.force[i] = state.contact_force[i];
  if (couples_system(model)) couple_system(model, state, w, c, result.system);
  const bool has_runners = c.rows > c.contacts;
  CoupledRunners runners;
  if (has_runners) couple_runners(model, stage, state, w, c, runners);
  solve_all(model, stage, state, w, c, has_runners ? &runners : nullptr, result);
  if (has_runners)
    result.status = result.status | move_coupled_runners(model, c, runners, state, w);
  move_track(model, w, c);
  move_vehicles(model, w, c);
  if (model.fixed.count > 0) apply_fixed_port_forces(model, c, state, w);
  finish_track(model, w);
  publish_wheels(model, c, state, result);
  return result;
}

}  // namespace railstep
