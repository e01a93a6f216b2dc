#include "online/step/step.h"

#include "online/contact/couple.h"
#include "online/contact/external.h"
#include "online/contact/system_coupling.h"
#include "online/math/float_mode.h"
#include "online/math/tiny.h"
#include "online/model/external_input.h"
#include "online/model/progress.h"
#include "online/runner/runner_step.h"
#include "online/step/copy_outputs.h"
#include "online/step/input.h"
#include "online/step/publish.h"
#include "online/system/system_step.h"
#include "online/system/track_ports.h"
#include "online/track/moving_load.h"
#include "online/track/shift_window.h"

namespace railstep {

namespace {

/// u*, v* of bodies and banded lines: the scheme's prediction without this step's acceleration.
void predict(const Model& model, const State& s, Workspace& w) noexcept {
  const Scheme c = model.scheme;
#pragma omp simd
  for (std::int32_t i = modal_unknowns(model); i < model.unknowns; ++i) {
    w.u_star[i] = ((s.u[i] + c.uv * s.v[i]) + c.ua * s.a[i]) + c.ug * s.g[i];
    w.v_star[i] = (s.v[i] + c.va * s.a[i]) + c.vg * s.g[i];
  }
}

/// The same for a scheme's second stage, from the end of the first.
void predict_last(const Model& model, const State& s, Workspace& w) noexcept {
  const double weight = model.scheme.stage_weight, per_kv = 1. / model.scheme.kv;
  const double *u0 = w.start, *v0 = w.start + model.unknowns;
#pragma omp simd
  for (std::int32_t i = 0; i < model.unknowns; ++i) {
    w.v_star[i] = v0[i] + weight * (s.v[i] - v0[i]);
    w.u_star[i] = (u0[i] + weight * (s.u[i] - u0[i])) + per_kv * w.v_star[i];
  }
}

/// Adds M kg u* + C (kv u* - v*) of every banded line to the right-hand side.
void add_inertia(const Model& model, Workspace& w) noexcept {
  const Scheme c = model.scheme;
#pragma omp simd
  for (std::int32_t i = 0; i < model.line_unknowns; ++i) w.scaled[i] = c.kg * w.u_star[i];
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const std::int32_t at = model.line[l].first;
    diagonals_multiply_add(model.line[l].mass, w.scaled + at, w.solved + at);
  }
#pragma omp simd
  for (std::int32_t i = 0; i < model.line_unknowns; ++i)
    w.scaled[i] = c.kv * w.u_star[i] - w.v_star[i];
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const std::int32_t at = model.line[l].first;
    diagonals_multiply_add(model.line[l].damping, w.scaled + at, w.solved + at);
  }
}

/// Whether there are forces on the track other than those of wheels and ports.
bool has_forces(const Model& model) noexcept {
  return model.loads > 0 || model.constant_force != nullptr;
}

/// The track's displacements without wheels, from the loads on the right-hand side.
void solve_bands(const Model& model, Workspace& w) noexcept {
  for (std::int32_t l = 0; l < model.lines; ++l)
    solve_band(model.line[l].step, w.solved + model.line[l].first);
}

/// Modes without wheels at the step's end; the forces q1 in `solved` are stored in the state.
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
    a[k] = without_tiny(q_re);
    g[k] = without_tiny(q_im);
  }
}

/// The same for modes without forces: q1 is 0 and was 0. Leaves bodies without a force.
void keep_modes(const Model& model, const State& s, Workspace& w) noexcept {
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineModel& line = model.line[l];
    modes_multiply(line.modal.keep, {s.u + line.first, s.v + line.first}, w.solved + line.first,
                   w.imaginary + line.first, line.size);
  }
  for (std::int32_t i = model.line_unknowns; i < model.unknowns; ++i) w.solved[i] = 0.;
}

/// Right-hand sides of banded lines, and condensed lines without wheels at the step's end.
void advance_track(const Model& model, const Stage& stage, State& s, Workspace& w) noexcept {
  if (model.form == Form::condensed && !has_forces(model)) return keep_modes(model, s, w);
  forces(model, stage.step, w.solved, w.imaginary, stage.before);
  if (model.form == Form::banded) return add_inertia(model, w);
  for (std::int32_t l = 0; l < model.lines; ++l) advance_modes(model.line[l], s, w);
}

void correct(const Model& model, State& s, const Workspace& w) noexcept {
  const Scheme c = model.scheme;
  const std::int32_t first = modal_unknowns(model);
#pragma omp simd
  for (std::int32_t i = 0; i < first; ++i) {
    s.u[i] = without_tiny(w.solved[i]);
    s.v[i] = without_tiny(w.imaginary[i]);
  }
#pragma omp simd
  for (std::int32_t i = first; i < model.unknowns; ++i) {
    const double change = w.solved[i] - w.u_star[i];
    const double g = c.kg * change;
    s.u[i] = without_tiny(w.solved[i]);
    s.v[i] = without_tiny(w.v_star[i] + c.kv * change);
    s.a[i] = without_tiny((c.ag * g + c.a0 * s.g[i]) + c.aa * s.a[i]);
    s.g[i] = without_tiny(g);
  }
}

void finish_stage(const Model& model, const Stage& stage, State& s, const Workspace& w) noexcept {
  correct(model, s, w);
  if (model.wheelsets > 0) project_guides(model, stage, s);
}

/// Rigid rails leave nothing between runners and the rest.
void step_runners(const Model& model, const Stage& stage, State& s, Workspace& w,
                  Outputs& outputs) noexcept {
  if (model.runners == 0 || model.lines > 0) return;
  const RunnerResult met = solve_runners(model, stage, s, w);
  outputs.status = outputs.status | met.status;
  if (met.iterations > outputs.iterations) outputs.iterations = met.iterations;
}

/// Bodies and what joins them, beside lines that are at the step's end; those that hold rails
/// beside contacts are solved already.
void step_system(const Model& model, State& s, Workspace& w, Outputs& outputs) noexcept {
  const bool solved = couples_system(model);
  if (!solved) begin_system(model, s, w);
  read_ports(model, {w.solved, {w.solved, w.imaginary}},
             system_workspace_on(model.system, w.system, s.kept).free_ports);
  if (!solved) collect(solve_system(model, s, w), outputs);
  leave_system(model, s, w);
}

/// Whether a stage's ports are solved together with its track.
bool has_ports(const Model& model) noexcept { return port_count(model) > 0; }

/// The first of two stages: afterwards the state is at its end, and the step's start in `w.start`.
/// Forces of external wheels hold for both.
void make_first_stage(const Model& model, State& state, Workspace& w, Outputs& outputs,
                      ExternalContact* external) noexcept {
  const Stage stage = first_stage(model.scheme, state.steps + 1);
#pragma omp simd
  for (std::int32_t i = 0; i < model.unknowns; ++i) {
    w.start[i] = state.u[i];
    w.start[model.unknowns + i] = state.v[i];
  }
  predict(model, state, w);
  advance_track(model, stage, state, w);
  if (model.external_wheels > 0) apply_external_forces(model, stage.step, state, w, external);
  if (has_ports(model))
    collect_solve(couple(model, stage, external, state, w), outputs);
  else
    solve_bands(model, w);
  step_runners(model, stage, state, w, outputs);
  finish_stage(model, stage, state, w);
}

/// @param external  [external_wheels] overwritten
void make_step(const Model& model, State& state, Workspace& w, Outputs& outputs,
               ExternalContact* external) noexcept {
  shift_window(model, state.steps + 1, state, w);
  const Stage stage = last_stage(model.scheme, state.steps + 1);
  if (model.scheme.stage_fraction > 0.) {
    make_first_stage(model, state, w, outputs, external);
    predict_last(model, state, w);
  } else {
    predict(model, state, w);
  }
  advance_track(model, stage, state, w);
  if (model.external_wheels > 0) apply_external_forces(model, stage.step, state, w, external);
  if (has_ports(model)) {
    const CoupleResult met = couple(model, stage, external, state, w);
    collect(model, state, met, outputs);
    if (couples_system(model)) collect(met.system, outputs);
  } else if (model.form == Form::banded) {
    solve_bands(model, w);
  }
  step_runners(model, stage, state, w, outputs);
  if (model.system.unknowns > 0) step_system(model, state, w, outputs);
  finish_stage(model, stage, state, w);
  if (model.system.unknowns > 0) outputs.status = outputs.status | finish_system(model, state, w);
  ++state.steps;
}

}  // namespace

void forces(const Model& model, std::int64_t step, double* re, double* im, double before) noexcept {
  const double* constant = model.constant_force;
#pragma omp simd
  for (std::int32_t i = 0; i < model.unknowns; ++i) re[i] = constant == nullptr ? 0. : constant[i];
#pragma omp simd
  for (std::int32_t i = 0; i < modal_unknowns(model); ++i)
    im[i] = constant == nullptr ? 0. : constant[model.unknowns + i];
  for (std::int32_t i = 0; i < model.loads; ++i) {
    const PlacedLoad at = place(model, model.load[i], step, before);
    for (std::int32_t l = 0; l < model.lines && at.on_rail; ++l)
      if (model.form == Form::condensed)
        spread_modes(model.line[l], at.row, at.force, re, im);
      else
        spread(model.line[l], at.row, at.force, re);
  }
}

namespace {

/// Publishes a frame that has been made. If its state is no longer finite, the outputs of the last
/// frame stay. This is not part of make_frame(), so that the copy of all outputs takes no stack
/// under the steps.
/// @param last  contacts before the frame's steps
[[gnu::noinline]] void publish_frame(const Model& model, const State& state, Workspace& workspace,
                                     const ExternalContact* external, const ContactOutputs& last,
                                     Outputs& outputs) noexcept {
  Outputs before;
  copy_published(model, outputs, before);
  restore_contacts(model, last, before);
  if (model.external_wheels > 0) {
    publish_external(model, state, external, outputs);
    publish_external_rates(model, state, external, workspace, outputs);
  }
  publish(model, state, outputs);
  if (has(outputs.status, Status::nonfinite_state)) copy_published(model, before, outputs);
}

// Never inlined: none of their arithmetic may move out of the mode that their callers set.
[[gnu::noinline]] void make_frame(const Model& model, State& state, Workspace& workspace,
                                  Outputs& outputs) noexcept {
  ContactOutputs last;
  keep_contacts(model, outputs, last);
  start_frame(model, state, outputs);
  ExternalContact external[kMaxExternalWheels];
  for (std::int32_t n = 0; n < model.steps_per_frame; ++n)
    make_step(model, state, workspace, outputs, external);
  publish_frame(model, state, workspace, external, last, outputs);
  state.latched = state.latched | (outputs.status & kLatched);
}

constexpr double kTrialForce = 1e3;  // N

/// The next frame under a force of an external wheel, kTrialForce along `row`; -1: no force.
/// @param moved  [3 external_wheels] out: displacements of the rail under the wheels
Status try_frame(const Model& model, const double* inputs, const State& state, Workspace& workspace,
                 int row, ExternalContact* external, double* moved) noexcept {
  State tried = copied_state(model, state, workspace.external);
  const Status met = take_inputs(model, inputs, tried);
  for (std::int32_t n = 0; n < model.external_wheels; ++n)
    for (int d = 0; d < 3; ++d)
      tried.input[model.external_wheel[n].input + kExternalForce + d] =
          external_row(n, d) == row ? kTrialForce : 0.;
  Outputs outputs;
  start_frame(model, tried, outputs);
  for (std::int32_t n = 0; n < model.steps_per_frame; ++n)
    make_step(model, tried, workspace, outputs, external);
  publish_external(model, tried, external, outputs);
  publish(model, tried, outputs);
  for (std::int32_t n = 0; n < model.external_wheels; ++n)
    for (int d = 0; d < 3; ++d) moved[external_row(n, d)] = outputs.external_displacement[n][d];
  return met | outputs.status;
}

/// Compliance where one solve does not give it: each force is tried.
/// @param external  [external_wheels] overwritten
void try_compliance(const Model& model, const double* inputs, const State& state,
                    Workspace& workspace, ExternalContact* external, const double* free,
                    double* compliance) noexcept {
  const std::int32_t count = external_row(model.external_wheels, 0);
  for (std::int32_t j = 0; j < count; ++j) {
    double moved[3 * kMaxExternalWheels];
    static_cast<void>(try_frame(model, inputs, state, workspace, j, external, moved));
    for (std::int32_t i = 0; i < count; ++i)
      compliance[i * count + j] = (moved[i] - free[i]) / kTrialForce;
  }
  for (std::int32_t i = 0; i < count; ++i)
    for (std::int32_t j = 0; j < i; ++j)
      compliance[i * count + j] = compliance[j * count + i] =
          .5 * (compliance[i * count + j] + compliance[j * count + i]);
}

[[gnu::noinline]] Status respond(const Model& model, const double* inputs, const State& state,
                                 Workspace& workspace, double* free, double* compliance) noexcept {
  ExternalContact external[kMaxExternalWheels];
  const Status met = try_frame(model, inputs, state, workspace, -1, external, free);
  const bool is_one_solve = model.steps_per_frame == 1 && model.scheme.stage_fraction == 0.;
  // Other contacts give way too.
  if (!is_one_solve || has_ports(model) || model.runners > 0 || model.system.ports > 0)
    try_compliance(model, inputs, state, workspace, external, free, compliance);
  else
    external_compliance(model, external, workspace, compliance);
  return met;
}

}  // namespace

Status advance_frame(const Model& model, State& state, Workspace& workspace,
                     Outputs& outputs) noexcept {
  if (has(state.latched, Status::nonfinite_state)) return outputs.status = state.latched;
  const FloatMode flushed_to_zero;
  make_frame(model, state, workspace, outputs);
  return outputs.status;
}

Status advance_frame(const Model& model, const double* inputs, State& state, Workspace& workspace,
                     Outputs& outputs) noexcept {
  state.latched = state.latched | take_inputs(model, inputs, state);
  return advance_frame(model, state, workspace, outputs);
}

Status external_response(const Model& model, const double* inputs, const State& state,
                         Workspace& workspace, double* free, double* compliance) noexcept {
  const FloatMode flushed_to_zero;
  return respond(model, inputs, state, workspace, free, compliance);
}

void publish_start(const Model& model, const State& state, Outputs& outputs) noexcept {
  const FloatMode flushed_to_zero;
  start_outputs(model, state, outputs);
}

}  // namespace railstep
