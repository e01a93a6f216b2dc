#include "online/step/step.h"

#include "online/model/course.h"
#include "online/step/couple.h"
#include "online/step/float_mode.h"
#include "online/step/follow.h"
#include "online/step/load.h"
#include "online/step/residual.h"
#include "online/step/vehicle_contact.h"
#include "online/step/wheel.h"
#include "online/system/system_step.h"

namespace railstep {

namespace {

Configuration standing(const Model& model, const State& s) noexcept {
  return {s.u, {s.u, s.v}, passed(model, s.steps)};
}

/// u*, v*: where the scheme goes without this step's acceleration, of bodies and banded lines.
void predict(const Model& model, const State& s, Workspace& w) noexcept {
  const Scheme c = model.scheme;
#pragma omp simd
  for (std::int32_t i = model.condensed * model.bodies; i < model.unknowns; ++i) {
    w.u_star[i] = ((s.u[i] + c.uv * s.v[i]) + c.ua * s.a[i]) + c.ug * s.g[i];
    w.v_star[i] = (s.v[i] + c.va * s.a[i]) + c.vg * s.g[i];
  }
}

/// M kg u* + C (kv u* - v*) of every banded line onto the right-hand side.
void add_inertia(const Model& model, Workspace& w) noexcept {
  const Scheme c = model.scheme;
#pragma omp simd
  for (std::int32_t i = 0; i < model.bodies; ++i) w.scaled[i] = c.kg * w.u_star[i];
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const std::int32_t at = model.line[l].first;
    diagonals_multiply_add(model.line[l].mass, w.scaled + at, w.solved + at);
  }
#pragma omp simd
  for (std::int32_t i = 0; i < model.bodies; ++i) w.scaled[i] = c.kv * w.u_star[i] - w.v_star[i];
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const std::int32_t at = model.line[l].first;
    diagonals_multiply_add(model.line[l].damping, w.scaled + at, w.solved + at);
  }
}

/// Whether anything but wheels and ports presses the track.
bool is_pressed(const Model& model) noexcept {
  return model.loads > 0 || model.constant_force != nullptr;
}

/// The track's displacements without wheels, for loads that stand on the right-hand side.
void solve_bands(const Model& model, Workspace& w) noexcept {
  for (std::int32_t l = 0; l < model.lines; ++l)
    solve_band<1>(model.line[l].step, w.solved + model.line[l].first, 0);
}

/// Modes without wheels at the step's end; the forces q1 in `solved` pass into the state.
void advance_modes(const LineModel& line, State& s, Workspace& w) noexcept {
  const Modal& m = line.modal;
  const double *keep_re = m.keep.re, *keep_im = m.keep.im;
  const double *old_re = m.old_force.re, *old_im = m.old_force.im;
  const double *new_re = m.new_force.re, *new_im = m.new_force.im;
  const double *u = s.u + line.first, *v = s.v + line.first;
  double *a = s.a + line.first, *g = s.g + line.first;
  double *re = w.solved + line.first, *im = w.imaginary + line.first;
#pragma omp simd
  for (std::int32_t k = 0; k < line.size; ++k) {
    const double q_re = re[k], q_im = im[k];
    re[k] = (((keep_re[k] * u[k] - keep_im[k] * v[k]) + (old_re[k] * a[k] - old_im[k] * g[k])) +
             (new_re[k] * q_re - new_im[k] * q_im));
    im[k] = (((keep_re[k] * v[k] + keep_im[k] * u[k]) + (old_re[k] * g[k] + old_im[k] * a[k])) +
             (new_re[k] * q_im + new_im[k] * q_re));
    a[k] = q_re;
    g[k] = q_im;
  }
}

/// The same of modes that nothing presses: q1 is 0, and was. Leaves bodies without a force.
void keep_modes(const Model& model, const State& s, Workspace& w) noexcept {
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineModel& line = model.line[l];
    modes_multiply(line.modal.keep, {s.u + line.first, s.v + line.first}, w.solved + line.first,
                   w.imaginary + line.first, line.size);
  }
  for (std::int32_t i = model.bodies; i < model.unknowns; ++i) w.solved[i] = 0.;
}

/// Right-hand sides of banded lines, and condensed ones without wheels at the step's end.
void advance_track(const Model& model, State& s, Workspace& w) noexcept {
  if (model.condensed != 0 && !is_pressed(model)) return keep_modes(model, s, w);
  forces(model, s.steps + 1, w.solved, w.imaginary);
  if (model.condensed == 0) return add_inertia(model, w);
  for (std::int32_t l = 0; l < model.lines; ++l) advance_modes(model.line[l], s, w);
}

void correct(const Model& model, State& s, const Workspace& w) noexcept {
  const Scheme c = model.scheme;
  const std::int32_t first = model.condensed * model.bodies;
#pragma omp simd
  for (std::int32_t i = 0; i < first; ++i) {
    s.u[i] = w.solved[i];
    s.v[i] = w.imaginary[i];
  }
#pragma omp simd
  for (std::int32_t i = first; i < model.unknowns; ++i) {
    const double change = w.solved[i] - w.u_star[i];
    const double g = c.kg * change;
    s.u[i] = w.solved[i];
    s.v[i] = w.v_star[i] + c.kv * change;
    s.a[i] = (c.ag * g + c.a0 * s.g[i]) + c.aa * s.a[i];
    s.g[i] = g;
  }
}

/// First unknown that is not finite, or -1. x - x is 0 for finite x alone.
std::int32_t first_bad(const Model& model, const State& s) noexcept {
  double sum = 0.;
  for (std::int32_t i = 0; i < model.unknowns; ++i) sum += (s.u[i] - s.u[i]) + (s.v[i] - s.v[i]);
  if (sum == 0.) return -1;
  for (std::int32_t i = 0; i < model.unknowns; ++i)
    if (!(s.u[i] - s.u[i] == 0.) || !(s.v[i] - s.v[i] == 0.)) return i;
  return -1;
}

void start_frame(const Model& model, Outputs& out) noexcept {
  out.status = Status::ok;
  out.constraint_violation = 0.;
  out.iterations = 0;
  out.force_residual = 0.;
  out.redundant_rows = 0;
  for (std::int32_t i = 0; i < wheel_count(model); ++i)
    out.wheel_force_peak[i] = out.wheel_impulse[i] = 0.;
  for (std::int32_t i = 0; i < 2 * model.flanges; ++i)
    out.flange_force_peak[i] = out.flange_impulse[i] = 0.;
}

void collect_flanges(const Model& model, const State& s, const double* gap, Outputs& out) noexcept {
  for (std::int32_t i = 0; i < 2 * model.flanges; ++i) {
    const double force = s.wheel_force[wheel_count(model) + i];
    out.flange_force[i] = force;
    out.flange_impulse[i] += force * model.scheme.dt;
    if (force > out.flange_force_peak[i]) out.flange_force_peak[i] = force;
    out.flange_gap[i] = gap[i];
  }
}

/// Adds what a step met to the frame's outputs.
void collect(const Model& model, const State& s, const CoupleResult& met, Outputs& out) noexcept {
  out.status = out.status | met.status;
  if (met.violation > out.constraint_violation) out.constraint_violation = met.violation;
  if (met.iterations > out.iterations) out.iterations = met.iterations;
  const double gone_by = passed(model, s.steps + 1);
  for (std::int32_t i = 0; i < wheel_count(model); ++i) {
    const double force = s.wheel_force[i];
    out.wheel_force[i] = force;
    out.wheel_impulse[i] += force * model.scheme.dt;
    out.wheel_force_mean[i] = out.wheel_impulse[i] / (model.scheme.dt * model.steps_per_frame);
    if (force > out.wheel_force_peak[i]) out.wheel_force_peak[i] = force;
    out.wheel_gap[i] = met.gap[i];
    out.wheel_x[i] = met.x[i] + gone_by;
    out.wheel_place[i] = met.x[i];
    out.wheel_on_rail[i] = met.on_rail[i];
  }
  collect_flanges(model, s, met.gap + wheel_count(model), out);
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

void make_step(const Model& model, State& state, Workspace& w, Outputs& outputs) noexcept {
  follow_traffic(model, state.steps + 1, state, w);
  predict(model, state, w);
  advance_track(model, state, w);
  if (wheel_count(model) > 0 || model.fixed.count > 0)
    collect(model, state, couple(model, state.steps + 1, state, w), outputs);
  else if (model.condensed == 0)
    solve_bands(model, w);
  if (model.system.unknowns > 0) collect(solve_system(model, state, w), outputs);
  correct(model, state, w);
  if (model.wheelsets > 0) project_guides(model, state.steps + 1, state);
  if (model.system.unknowns > 0) outputs.status = outputs.status | finish_system(model, state, w);
  ++state.steps;
}

}  // namespace

void forces(const Model& model, std::int64_t step, double* re, double* im) noexcept {
  const double* constant = model.constant_force;
#pragma omp simd
  for (std::int32_t i = 0; i < model.unknowns; ++i) re[i] = constant == nullptr ? 0. : constant[i];
#pragma omp simd
  for (std::int32_t i = 0; i < model.condensed * model.bodies; ++i)
    im[i] = constant == nullptr ? 0. : constant[model.unknowns + i];
  for (std::int32_t i = 0; i < model.loads; ++i) {
    const PlacedLoad at = place(model, model.load[i], step);
    for (std::int32_t l = 0; l < model.lines && at.on_rail; ++l)
      if (model.condensed != 0)
        spread_modes(model.line[l], at.row, at.force, re, im);
      else
        spread(model.line[l], at.row, at.force, re);
  }
}

namespace {

/// Loads and health of a state as it stands, on what a frame has collected.
void publish(const Model& model, const State& state, Outputs& outputs) noexcept {
  for (std::int32_t i = 0; i < model.loads; ++i) {
    const PlacedLoad at = place(model, model.load[i], state.steps);
    outputs.load_x[i] = at.x;
    outputs.load_place[i] = at.place;
    outputs.load_force[i] = at.force;
    outputs.load_deflection[i] = at.on_rail ? deflection(model, at, standing(model, state)) : 0.;
    if (!at.on_rail) outputs.status = outputs.status | Status::off_rail;
  }
  RailForce force[kMaxLoads + kMaxWheels];
  const int count = rail_forces(model, outputs, force);
  for (std::int32_t i = 0; i < model.loads; ++i)
    outputs.load_deflection[i] += residual_displacement(model, force, count, i);
  for (std::int32_t i = 0; i < wheel_count(model); ++i) {
    const RailForce& own = force[model.loads + i];
    outputs.wheel_rail_z[i] = 0.;
    if (!outputs.wheel_on_rail[i]) continue;
    outputs.wheel_rail_z[i] =
        axis_height(model, wheel_rail(model, i), own.element, own.xi, standing(model, state)) +
        residual_displacement(model, force, count, model.loads + i) +
        own.force * (residual_axis(model, own) - residual_under(model, own));
  }
  outputs.first_bad_unknown = first_bad(model, state);
  if (outputs.first_bad_unknown >= 0) outputs.status = outputs.status | Status::nonfinite_state;
}

// Never inlined: no arithmetic of theirs may leave the mode that their callers set.
[[gnu::noinline]] void frame(const Model& model, State& state, Workspace& workspace,
                             Outputs& outputs) noexcept {
  start_frame(model, outputs);
  for (std::int32_t n = 0; n < model.steps_per_frame; ++n)
    make_step(model, state, workspace, outputs);
  publish(model, state, outputs);
}

[[gnu::noinline]] void start_outputs(const Model& model, const State& state,
                                     Outputs& outputs) noexcept {
  start_frame(model, outputs);
  WheelContact contact[kMaxWheels];
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    find_contacts(model, model.wheelset[b], standing(model, state), contact + 2 * b);
  for (std::int32_t v = 0; v < model.vehicles; ++v)
    find_vehicle_contacts(model, model.vehicle[v], state.steps, 0., standing(model, state),
                          contact);
  for (std::int32_t i = 0; i < wheel_count(model); ++i) {
    outputs.wheel_force[i] = outputs.wheel_force_mean[i] = outputs.wheel_force_peak[i] =
        state.wheel_force[i];
    outputs.wheel_gap[i] = -contact[i].penetration;
    outputs.wheel_on_rail[i] = contact[i].on_rail;
    outputs.wheel_place[i] = contact[i].x;
    outputs.wheel_x[i] = contact[i].x + passed(model, state.steps);
  }
  for (std::int32_t f = 0; f < model.flanges; ++f)
    find_flanges(model, model.flange[f], standing(model, state), contact + 2 * f);
  for (std::int32_t i = 0; i < 2 * model.flanges; ++i) {
    outputs.flange_force[i] = outputs.flange_force_peak[i] =
        state.wheel_force[wheel_count(model) + i];
    outputs.flange_gap[i] = -contact[i].penetration;
  }
  publish(model, state, outputs);
  RailForce force[kMaxLoads + kMaxWheels];
  const int count = rail_forces(model, outputs, force);
  for (std::int32_t i = 0; i < wheel_count(model); ++i)
    if (outputs.wheel_on_rail[i])
      outputs.wheel_gap[i] -= residual_displacement(model, force, count, model.loads + i);
}

}  // namespace

Status advance_frame(const Model& model, State& state, Workspace& workspace,
                     Outputs& outputs) noexcept {
  const FloatMode flushed_to_zero;
  frame(model, state, workspace, outputs);
  return outputs.status;
}

void publish_start(const Model& model, const State& state, Outputs& outputs) noexcept {
  const FloatMode flushed_to_zero;
  start_outputs(model, state, outputs);
}

}  // namespace railstep
