#include "online/step/track_response.h"

namespace railstep {

namespace {

Complex row_of(const Model& model, const Workspace& w, int wheel) noexcept {
  const double* re = w.row + 2 * static_cast<std::ptrdiff_t>(wheel) * model.unknowns;
  return {re, re + model.unknowns};
}

/// Solves each banded line for itself and for the wheels that touch it, together where they can be.
void solve_bands(const Model& model, Workspace& w, const Coupling& c) noexcept {
  const std::ptrdiff_t stride = model.unknowns;
  for (int i = 0; i < c.wheels; ++i) {
    double* rhs = w.solved + (i + 1) * stride;
    for (std::int32_t k = 0; k < model.bodies; ++k) rhs[k] = 0.;
    if (!c.contact[i].on_rail) continue;
    for (std::int32_t l = 0; l < model.lines; ++l) spread(model.line[l], c.contact[i].row, 1., rhs);
  }
  for (std::int32_t l = 0; l < model.lines; ++l) {
    double* x = w.solved + model.line[l].first;
    const bool both = model.line[l].rail_factor[0] != 0. && model.line[l].rail_factor[1] != 0.;
    const int together = both && c.wheels >= 2 ? 2 : 0;
    if (together == 2)
      solve_band<3>(model.line[l].step, x, stride);
    else
      solve_band<1>(model.line[l].step, x, stride);
    for (int i = together; i < c.wheels; ++i)
      if (c.contact[i].on_rail && model.line[l].rail_factor[c.contact[i].row.rail] != 0.)
        solve_band<1>(model.line[l].step, x + (i + 1) * stride, stride);
  }
}

/// What a unit force under each wheel, held over the step, makes of every condensed line.
void respond_modes(const Model& model, Workspace& w, const Coupling& c) noexcept {
  const std::ptrdiff_t stride = model.unknowns;
  for (int i = 0; i < c.wheels; ++i) {
    double* re = w.row + 2 * i * stride;
    double* im = re + stride;
    for (std::int32_t k = 0; k < model.bodies; ++k) re[k] = im[k] = 0.;
    for (std::int32_t l = 0; l < model.lines && c.contact[i].on_rail; ++l)
      spread_modes(model.line[l], c.contact[i].row, 1., re, im);
    for (std::int32_t l = 0; l < model.lines; ++l) {
      const LineModel& line = model.line[l];
      modes_multiply(line.modal.held_force, {re + line.first, im + line.first},
                     w.solved + (i + 1) * stride + line.first,
                     w.imaginary + (i + 1) * stride + line.first, line.size);
    }
  }
}

}  // namespace

void respond(const Model& model, Workspace& w, const Coupling& c) noexcept {
  if (model.condensed != 0)
    respond_modes(model, w, c);
  else
    solve_bands(model, w, c);
}

double track_under(const Model& model, const Workspace& w, const Coupling& c, int i,
                   const double* re, const double* im) noexcept {
  if (model.condensed != 0) return modes_dot(row_of(model, w, i), {re, im}, model.bodies);
  double sum = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l)
    sum += motion(model.line[l], c.contact[i].row, {re, {}});
  return sum;
}

double track_compliance(const Model& model, const Workspace& w, const Coupling& c, int i,
                        int j) noexcept {
  const std::ptrdiff_t unit = static_cast<std::ptrdiff_t>(j + 1) * model.unknowns;
  return track_under(model, w, c, i, w.solved + unit, w.imaginary + unit);
}

double track_motion(const Model& model, const State& s, const Workspace& w, const Coupling& c,
                    int i) noexcept {
  const Configuration seen = located_on(model, s, w);
  if (model.condensed != 0)
    return modes_dot(row_of(model, w, i), {w.solved, w.imaginary}, model.bodies) -
           modes_dot(row_of(model, w, i), seen.modes, model.bodies);
  const RailRow& row = c.contact[i].row;
  double moved = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l)
    moved += motion(model.line[l], row, {w.solved, {}}) - motion(model.line[l], row, seen);
  return moved;
}

void move_track(const Model& model, Workspace& w, const Coupling& c) noexcept {
  for (int i = 0; i < c.wheels; ++i) {
    const std::ptrdiff_t unit = static_cast<std::ptrdiff_t>(i + 1) * model.unknowns;
    for (std::int32_t l = 0; l < model.lines; ++l) {
      const LineModel& line = model.line[l];
      if (line.rail_factor[c.contact[i].row.rail] == 0.) continue;
#pragma omp simd
      for (std::int32_t k = line.first; k < line.first + line.size; ++k)
        w.solved[k] -= c.force[i] * w.solved[unit + k];
      if (model.condensed == 0) continue;
#pragma omp simd
      for (std::int32_t k = line.first; k < line.first + line.size; ++k)
        w.imaginary[k] -= c.force[i] * w.imaginary[unit + k];
    }
  }
}

}  // namespace railstep
