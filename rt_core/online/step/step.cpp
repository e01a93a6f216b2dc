#include "online/step/step.h"

#include "online/step/couple.h"
#include "online/step/float_mode.h"
#include "online/step/load.h"
#include "online/step/wheel.h"

namespace railstep {

namespace {

/// u*, v*: where the scheme goes without this step's acceleration.
void predict(const Model& model, const State& s, Workspace& w) noexcept {
  const Scheme c = model.scheme;
#pragma omp simd
  for (std::int32_t i = 0; i < model.unknowns; ++i) {
    w.u_star[i] = ((s.u[i] + c.uv * s.v[i]) + c.ua * s.a[i]) + c.ug * s.g[i];
    w.v_star[i] = (s.v[i] + c.va * s.a[i]) + c.vg * s.g[i];
  }
}

/// M kg u* + C (kv u* - v*) of every line into the right-hand side.
void inertia(const Model& model, Workspace& w) noexcept {
  const Scheme c = model.scheme;
#pragma omp simd
  for (std::int32_t i = 0; i < model.unknowns; ++i) {
    w.solved[i] = model.constant_force == nullptr ? 0. : model.constant_force[i];
    w.scaled[i] = c.kg * w.u_star[i];
  }
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const std::int32_t at = model.line[l].first;
    diagonals_multiply_add(model.line[l].mass, w.scaled + at, w.solved + at);
  }
#pragma omp simd
  for (std::int32_t i = 0; i < model.unknowns; ++i) w.scaled[i] = c.kv * w.u_star[i] - w.v_star[i];
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const std::int32_t at = model.line[l].first;
    diagonals_multiply_add(model.line[l].damping, w.scaled + at, w.solved + at);
  }
}

void add_loads(const Model& model, std::int64_t step, Workspace& w) noexcept {
  for (std::int32_t i = 0; i < model.loads; ++i) {
    const PlacedLoad at = place(model, model.load[i], step);
    if (!at.on_rail) continue;
    for (std::int32_t l = 0; l < model.lines; ++l)
      spread(model.line[l], model.load[i], at, w.solved + model.line[l].first);
  }
}

void solve(const Model& model, Workspace& w) noexcept {
  for (std::int32_t l = 0; l < model.lines; ++l)
    solve_band<1>(model.line[l].step, w.solved + model.line[l].first, 0);
}

void correct(const Model& model, State& s, const Workspace& w) noexcept {
  const Scheme c = model.scheme;
#pragma omp simd
  for (std::int32_t i = 0; i < model.unknowns; ++i) {
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
  for (std::int32_t i = 0; i < 2 * model.wheelsets; ++i)
    out.wheel_force_peak[i] = out.wheel_impulse[i] = 0.;
}

/// Adds what a step met to the frame's outputs.
void collect(const Model& model, const State& s, const CoupleResult& met, Outputs& out) noexcept {
  out.status = out.status | met.status;
  if (met.violation > out.constraint_violation) out.constraint_violation = met.violation;
  if (met.iterations > out.iterations) out.iterations = met.iterations;
  for (std::int32_t i = 0; i < 2 * model.wheelsets; ++i) {
    const double force = s.wheel_force[i];
    out.wheel_force[i] = force;
    out.wheel_impulse[i] += force * model.scheme.dt;
    out.wheel_force_mean[i] = out.wheel_impulse[i] / (model.scheme.dt * model.steps_per_frame);
    if (force > out.wheel_force_peak[i]) out.wheel_force_peak[i] = force;
    out.wheel_gap[i] = met.gap[i];
    out.wheel_rail_z[i] = met.rail_z[i];
  }
}

}  // namespace

Status advance_frame(const Model& model, State& state, Workspace& workspace,
                     Outputs& outputs) noexcept {
  const FloatMode flushed_to_zero;
  start_frame(model, outputs);
  for (std::int32_t n = 0; n < model.steps_per_frame; ++n) {
    predict(model, state, workspace);
    inertia(model, workspace);
    add_loads(model, state.steps + 1, workspace);
    if (model.wheelsets > 0)
      collect(model, state, couple(model, state.steps + 1, state, workspace), outputs);
    else
      solve(model, workspace);
    correct(model, state, workspace);
    if (model.wheelsets > 0) project_guides(model, state);
    ++state.steps;
  }
  publish(model, state, outputs);
  return outputs.status;
}

void publish(const Model& model, const State& state, Outputs& outputs) noexcept {
  for (std::int32_t i = 0; i < model.loads; ++i) {
    const PlacedLoad at = place(model, model.load[i], state.steps);
    outputs.load_x[i] = at.x;
    outputs.load_force[i] = at.force;
    outputs.load_deflection[i] = at.on_rail ? deflection(model, model.load[i], at, state.u) : 0.;
    if (!at.on_rail) outputs.status = outputs.status | Status::off_rail;
  }
  outputs.first_bad_unknown = first_bad(model, state);
  if (outputs.first_bad_unknown >= 0) outputs.status = outputs.status | Status::nonfinite_state;
}

void publish_start(const Model& model, const State& state, Outputs& outputs) noexcept {
  start_frame(model, outputs);
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    for (int side = 0; side < 2; ++side) {
      const int i = 2 * b + side;
      const WheelContact at = find_contact(model, model.wheelset[b], side, state.u);
      outputs.wheel_force[i] = outputs.wheel_force_mean[i] = outputs.wheel_force_peak[i] =
          state.wheel_force[i];
      outputs.wheel_gap[i] = -at.penetration;
      outputs.wheel_rail_z[i] = at.on_rail ? axis_height(model, at, state.u) : 0.;
    }
  publish(model, state, outputs);
}

}  // namespace railstep
