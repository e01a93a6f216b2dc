#include "online/step/many.h"

#include "online/math/float_mode.h"
#include "online/step/common.h"
#include "online/step/input.h"
#include "online/step/stages.h"

namespace railstep {

namespace {

std::int64_t padded(std::int64_t n) noexcept { return (n + 7) / 8 * 8 + 8; }

std::int64_t own_doubles(const Model& model) noexcept {
  return padded((4LL + model.condensed) * model.unknowns);
}

template <int R>
void solve_group(const Model& model, const ManyWorkspace& many, int from) noexcept {
  for (std::int32_t l = 0; l < model.lines; ++l)
    solve_band<R>(model.line[l].step, many.one[from].solved + model.line[l].first, many.stride);
}

void solve_bands(const Model& model, const ManyWorkspace& many, int count) noexcept {
  int done = 0;
  for (; done + 4 <= count; done += 4) solve_group<4>(model, many, done);
  for (; done < count; ++done) solve_group<1>(model, many, done);
}

void make_frames(const Model& model, State* const* state, int count, ManyWorkspace& many,
                 Outputs* const* outputs) noexcept {
  for (int i = 0; i < count; ++i) begin_frame(model, *state[i], *outputs[i], many.last[i]);
  for (std::int32_t n = 0; n < model.steps_per_frame; ++n) {
    for (int i = 0; i < count; ++i) begin_step(model, *state[i], many.one[i], *outputs[i], nullptr);
    if (model.condensed == 0) solve_bands(model, many, count);
    for (int i = 0; i < count; ++i) end_step(model, *state[i], many.one[i], *outputs[i]);
  }
  for (int i = 0; i < count; ++i)
    end_frame(model, *state[i], many.one[i], many.last[i], *outputs[i]);
}

/// In groups; states that are no longer finite stay out of them.
// Never inlined: no arithmetic may leave the mode that the caller sets.
[[gnu::noinline]] void make_all(const Model& model, State* states, int count, ManyWorkspace& many,
                                Outputs* outputs) noexcept {
  many.common->pressed = many.common->published = many.common->placed = -1;
  State* state[kTogether];
  Outputs* out[kTogether];
  int taken = 0;
  for (int i = 0; i < count; ++i) {
    if (has(states[i].latched, Status::nonfinite_state)) {
      outputs[i].status = states[i].latched;
    } else {
      state[taken] = states + i;
      out[taken++] = outputs + i;
    }
    if (taken == kTogether || i + 1 == count) {
      make_frames(model, state, taken, many, out);
      taken = 0;
    }
  }
}

/// Whether states of the model have anything in common.
bool has_common(const Model& model) noexcept {
  return model.system.unknowns == 0 && model.wheelsets == 0 && model.external_wheels == 0 &&
         model.scheme.part == 0.;
}

}  // namespace

std::int64_t many_bytes(const Model& model) noexcept {
  const std::int64_t doubles = padded(workspace_doubles(model)) +
                               padded((1LL + model.condensed) * model.unknowns) +
                               kTogether * own_doubles(model);
  return static_cast<std::int64_t>(sizeof(Common) + kTogether * sizeof(Outputs)) +
         static_cast<std::int64_t>(sizeof(double)) * doubles;
}

ManyWorkspace many_workspace_on(const Model& model, void* memory) noexcept {
  const std::int64_t n = model.unknowns;
  ManyWorkspace many{};
  many.common = static_cast<Common*>(memory);
  many.last = reinterpret_cast<Outputs*>(many.common + 1);
  double* const scratch = reinterpret_cast<double*>(many.last + kTogether);
  many.alone = workspace_on(model, scratch);
  double* const force = scratch + padded(workspace_doubles(model));
  many.common->force_re = force;
  many.common->force_im = force + model.condensed * n;
  double* const own = force + padded((1LL + model.condensed) * n);
  many.stride = own_doubles(model);
  for (int i = 0; i < kTogether; ++i) {
    double* const at = own + i * many.stride;
    Workspace& w = many.one[i];
    w = many.alone;
    w.common = many.common;
    w.u_star = at;
    w.v_star = at + n;
    w.scaled = at + 2 * n;
    w.solved = at + 3 * n;
    w.imaginary = at + (3 + model.condensed) * n;
  }
  return many;
}

Status advance_frames(const Model& model, State* states, int count, ManyWorkspace& many,
                      Outputs* outputs) noexcept {
  if (has_common(model)) {
    const FloatMode flushed_to_zero;
    make_all(model, states, count, many, outputs);
  } else {
    for (int i = 0; i < count; ++i)
      static_cast<void>(advance_frame(model, states[i], many.alone, outputs[i]));
  }
  Status met = Status::ok;
  for (int i = 0; i < count; ++i) met = met | outputs[i].status;
  return met;
}

Status advance_frames(const Model& model, const double* inputs, State* states, int count,
                      ManyWorkspace& many, Outputs* outputs) noexcept {
  for (int i = 0; i < count; ++i)
    states[i].latched =
        states[i].latched | take_inputs(model, inputs + i * model.inputs, states[i]);
  return advance_frames(model, states, count, many, outputs);
}

}  // namespace railstep
