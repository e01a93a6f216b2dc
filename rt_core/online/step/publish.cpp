#include "online/step/publish.h"

#include <bit>
#include <cstdint>

#include "online/contact/vehicle_contact.h"
#include "online/contact/wheel.h"
#include "online/math/finite.h"
#include "online/runner/runner_contact.h"
#include "online/system/marker.h"
#include "online/track/moving_load.h"
#include "online/track/residual.h"

namespace railstep {

namespace {

/// Far above every displacement of a rail or sleeper, m, and every rotation, rad: a linear track is
/// valid up to a few times a section's height. A run that grows from bay to bay or step to step
/// ends here, long before its numbers overflow.
constexpr double kMostSag = 0x1p10;

/// The highest bit is set if |x| >= `most` or x is NaN: without the sign, IEEE patterns sort like
/// magnitudes. It uses integers, so that several can be tested together.
std::uint64_t lifted(double x, double most) noexcept {
  constexpr std::uint64_t sign = std::uint64_t{1} << 63;
  return (std::bit_cast<std::uint64_t>(x) & ~sign) + (sign - std::bit_cast<std::uint64_t>(most));
}

/// First unknown of a range whose displacement is at least `most`, or whose velocity is too large;
/// or -1.
std::int32_t first_beyond(const State& s, std::int32_t first, std::int32_t last,
                          double most) noexcept {
  const auto at = [&](std::int32_t i) noexcept {
    return lifted(s.u[i], most) | lifted(s.v[i], kMostNumber);
  };
  std::uint64_t any = 0;
  for (std::int32_t i = first; i < last; ++i) any |= at(i);
  if (any >> 63 == 0) return -1;
  while (at(first) >> 63 == 0) ++first;
  return first;
}

/// First unknown of a body whose contact, orientation or joint has too large numbers, or -1. They
/// are high powers of unknowns, which overflow long before the unknowns do.
std::int32_t first_lost(const Model& model, const State& s, const Outputs& out) noexcept {
  for (const ContactId i : contacts(model))
    if (!is_moderate(out.contact_gap[i]) || !is_moderate(s.contact_force[i]))
      return bodies_of(model, i).first;
  const SystemModel& system = model.system;
  for (std::int32_t b = 0; b < system.bodies; ++b)
    for (int k = 0; k < 4; ++k)
      if (!is_moderate(s.quaternion[4 * b + k])) return system.body[b].first;
  for (std::int32_t i = 0; i < system_rows(system); ++i) {
    if (is_moderate(s.row_force[i])) continue;
    const UnknownRange b = unknowns_of(system, system.marker[system.row[i].b]);
    return b.count > 0 ? b.first : unknowns_of(system, system.marker[system.row[i].a]).first;
  }
  return -1;
}

/// First unknown that is too large, or -1.
std::int32_t first_bad(const Model& model, const State& s, const Outputs& out) noexcept {
  // In a condensed track these are modes, not displacements.
  const std::int32_t banded = model.line_unknowns - modal_unknowns(model);
  const std::int32_t track = first_beyond(s, 0, banded, kMostSag);
  if (track >= 0) return track;
  const std::int32_t other = first_beyond(s, banded, model.unknowns, kMostNumber);
  return other >= 0 ? other : first_lost(model, s, out);
}

}  // namespace

void start_frame(const Model& model, const State& state, Outputs& out) noexcept {
  out.status = state.latched;
  out.constraint_violation = 0.;
  out.iterations = 0;
  out.force_residual = 0.;
  out.redundant_rows = 0;
  for (const ContactId i : contacts(model)) out.contact_force_peak[i] = out.contact_impulse[i] = 0.;
}

void collect_solve(const CoupleResult& met, Outputs& out) noexcept {
  out.status = out.status | met.status;
  if (met.violation > out.constraint_violation) out.constraint_violation = met.violation;
  if (met.iterations > out.iterations) out.iterations = met.iterations;
}

void collect(const Model& model, const State& s, const CoupleResult& met, Outputs& out) noexcept {
  collect_solve(met, out);
  const double offset = track_offset(model, s.steps + 1);
  for (const ContactId i : contacts(model)) {
    const double force = s.contact_force[i];
    out.contact_force[i] = force;
    out.contact_impulse[i] += force * model.scheme.dt;
    out.contact_force_mean[i] = out.contact_impulse[i] / (model.scheme.dt * model.steps_per_frame);
    if (force > out.contact_force_peak[i]) out.contact_force_peak[i] = force;
    out.contact_gap[i] = met.gap[i];
    out.contact_x[i] = met.x[i] + offset;
    out.contact_place[i] = met.x[i];
    out.contact_on_rail[i] = met.on_rail[i];
  }
}

void collect(const SystemResult& met, Outputs& out) noexcept {
  out.status = out.status | met.status;
  if (!(met.violation <= out.constraint_violation)) out.constraint_violation = met.violation;
  if (!(met.force_residual <= out.force_residual)) out.force_residual = met.force_residual;
  if (met.iterations > out.iterations) out.iterations = met.iterations;
  if (met.redundant_rows == 0) return;
  out.redundant_rows = met.redundant_rows;
  for (int i = 0; i < kMostNamedRows; ++i) out.redundant_row[i] = met.redundant_row[i];
}

void publish(const Model& model, const State& state, Outputs& outputs) noexcept {
  outputs.status = outputs.status | publish_runners(model, state, outputs);
  for (std::int32_t i = 0; i < model.loads; ++i) {
    const PlacedLoad at = place(model, model.load[i], state.steps);
    outputs.load_x[i] = at.x;
    outputs.load_place[i] = at.place;
    outputs.load_force[i] = at.force;
    outputs.load_deflection[i] = at.on_rail ? motion(model, at.row, standing(model, state)) : 0.;
    if (!at.on_rail) outputs.status = outputs.status | Status::off_rail;
  }
  RailForce force[kMaxRailForces];
  const int count = rail_forces(model, outputs, force);
  double moved[kMaxRailForces];
  residual_displacements(model, force, count,
                         model.loads + wheel_count(model) + model.external_wheels, moved);
  for (std::int32_t i = 0; i < model.loads; ++i) outputs.load_deflection[i] += moved[i];
  for (const ContactId i : wheels(model)) {
    const RailForce& own = force[model.loads + i];
    outputs.contact_rail_z[i] = 0.;
    if (!outputs.contact_on_rail[i]) continue;
    outputs.contact_rail_z[i] =
        axis_height(model, model.contact[i].rail, own.element, own.xi, standing(model, state)) +
        moved[model.loads + i] +
        own.force * (residual_axis(model, own) - residual_under(model, own));
  }
  for (std::int32_t i = 0; i < model.external_wheels; ++i)
    if (outputs.external_on_rail[i])
      outputs.external_displacement[i][2] += moved[model.loads + wheel_count(model) + i];
  outputs.first_bad_unknown = first_bad(model, state, outputs);
  if (outputs.first_bad_unknown >= 0) outputs.status = outputs.status | Status::nonfinite_state;
}

void start_outputs(const Model& model, const State& state, Outputs& outputs) noexcept {
  start_frame(model, state, outputs);
  WheelContact contact[kMaxWheels];
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    find_contacts(model, b, standing(model, state), contact + tread_of(b, 0));
  find_vehicle_contacts(model, state.steps, 0., standing(model, state), contact);
  for (std::int32_t f = 0; f < model.flanges; ++f)
    find_flanges(model, model.flange[f], standing(model, state),
                 contact + flange_contact(model, flange_number(f, 0)));
  for (const ContactId i : contacts(model)) {
    outputs.contact_force[i] = outputs.contact_force_mean[i] = outputs.contact_force_peak[i] =
        state.contact_force[i];
    outputs.contact_gap[i] = -contact[i].penetration;
    outputs.contact_on_rail[i] = contact[i].on_rail;
    outputs.contact_place[i] = contact[i].x;
    outputs.contact_x[i] = contact[i].x + track_offset(model, state.steps);
  }
  if (model.external_wheels > 0) {
    ExternalContact external[kMaxExternalWheels];
    place_external(model, state.steps, state.input, standing(model, state), external);
    publish_external(model, state, external, outputs);
    for (auto& velocity : outputs.external_velocity) velocity[0] = velocity[1] = velocity[2] = 0.;
  }
  publish(model, state, outputs);
  RailForce force[kMaxRailForces];
  const int count = rail_forces(model, outputs, force);
  for (const ContactId i : wheels(model))
    if (outputs.contact_on_rail[i])
      outputs.contact_gap[i] -= residual_displacement(model, force, count, model.loads + i);
}

}  // namespace railstep
