#include "online/contact/track_response.h"

namespace railstep {

namespace {

/// The part of one line in a row.
Complex row_of(const Model& model, const Workspace& w, const LineModel& line, int row) noexcept {
  const double* re = w.row + 2 * static_cast<std::ptrdiff_t>(row) * model.unknowns + line.first;
  return {re, re + model.unknowns};
}

/// Whether a force along a row moves the line.
bool acts_on(const Coupling& c, int row, const LineModel& line) noexcept {
  return is_on_rail(c, row) && line.rail_factor[track_row(c, row).rail] != 0.;
}

/// Halfway solve of a banded line for a wheel's row.
/// @param unit  where the wheel's responses begin in the workspace
/// @param at    out: its panels
void respond_band(const LineModel& line, const RailRow& row, std::ptrdiff_t unit, Workspace& w,
                  Panels& at) noexcept {
  at = panels_of(line, row);
  at.end = at.end + line.reach < line.step.panels ? at.end + line.reach : line.step.panels;
  double *const half = w.unit + unit, *const second = w.unit_second + unit + line.first;
  for (std::int32_t k = kLanes * at.first; k < kLanes * at.end; ++k) half[line.first + k] = 0.;
  spread(line, row, 1., half);
  solve_forward(line.step, at, half + line.first);
  for (std::int32_t k = kLanes * at.first; k < kLanes * at.end; ++k)
    second[k] = half[line.first + k];
  divide_by_pivots(line.step, at, second);
}

/// Halfway solves of each banded line: of its own right-hand side, and of each wheel's row in the
/// panels that it reaches.
void respond_bands(const Model& model, Workspace& w, Coupling& c) noexcept {
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const Band& step = model.line[l].step;
    double* const own = w.solved + model.line[l].first;
    solve_forward(step, {0, step.panels}, own);
    divide_by_pivots(step, {0, step.panels}, own);
  }
  for (int i = 0; i < c.rows; ++i)
    for (std::int32_t l = 0; l < model.lines; ++l) {
      const LineModel& line = model.line[l];
      if (acts_on(c, i, line))
        respond_band(line, track_row(c, i), i * std::ptrdiff_t{model.unknowns}, w, c.panels[i][l]);
    }
}

/// Response of the condensed lines to a unit force under each wheel, held over the step.
void respond_modes(const Model& model, Workspace& w, const Coupling& c) noexcept {
  const std::ptrdiff_t stride = model.unknowns;
  for (int i = 0; i < c.rows; ++i) {
    double* re = w.row + 2 * i * stride;
    const std::ptrdiff_t unit = i * stride;
    for (std::int32_t l = 0; l < model.lines; ++l) {
      const LineModel& line = model.line[l];
      if (!acts_on(c, i, line)) continue;
      shape_row(line, track_row(c, i), re, re + stride);
      modes_multiply(line.modal.held_force, row_of(model, w, line, i), w.unit + unit + line.first,
                     w.unit_second + unit + line.first, line.size);
    }
  }
}

/// x -= sum of forces times the unit responses of a line, in whole panels, so that the line is read
/// and written once.
/// @param unit  [count] unit responses, from the line's first unknown on
void subtract(const double* const* unit, const double* force, int count, int size,
              double* x) noexcept {
  for (int k = 0; k < size; k += kLanes) {
    double sum[kLanes];
    for (int l = 0; l < kLanes; ++l) sum[l] = x[k + l];
    for (int i = 0; i < count; ++i) {
#pragma omp simd
      for (int l = 0; l < kLanes; ++l) sum[l] -= force[i] * unit[i][k + l];
    }
    for (int l = 0; l < kLanes; ++l) x[k + l] = sum[l];
  }
}

/// Part of the displacement under contact `i` by a line that a force there moves.
double line_under(const Model& model, const Workspace& w, const Coupling& c, const LineModel& line,
                  int i, const double* re, const double* im) noexcept {
  if (model.form == Form::banded) return motion(line, track_row(c, i), {re, {}});
  return modes_dot(row_of(model, w, line, i), {re + line.first, im + line.first}, line.size);
}

/// Displacement under wheel `i` by displacements `re` and, if condensed, `im` of the lines.
double track_under(const Model& model, const Workspace& w, const Coupling& c, int i,
                   const double* re, const double* im) noexcept {
  double sum = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l)
    if (acts_on(c, i, model.line[l])) sum += line_under(model, w, c, model.line[l], i, re, im);
  return sum;
}

/// Adds the compliance of a line to W by its table.
void add_tabled(const LineModel& line, Coupling& c) noexcept {
  CarriedRow carried[kMaxTrackRows];
  for (int i = 0; i < c.rows; ++i) {
    if (!acts_on(c, i, line)) continue;
    carry(line, track_row(c, i), carried[i]);
    for (int j = 0; j <= i; ++j)
      if (acts_on(c, j, line)) c.W[i * c.ports + j] += between(line.modal, carried[i], carried[j]);
  }
}

}  // namespace

void respond(const Model& model, const State& s, Workspace& w, Coupling& c) noexcept {
  if (model.form == Form::condensed)
    respond_modes(model, w, c);
  else
    respond_bands(model, w, c);
  for (int i = 0; i < c.rows; ++i)
    c.located[i] = model.form == Form::condensed ? track_under(model, w, c, i, s.u, s.v)
                                                 : track_under(model, w, c, i, w.scaled, nullptr);
}

double line_compliance(const Model& model, const Workspace& w, const Coupling& c, int i,
                       std::int32_t l, const LineResponse& by) noexcept {
  const LineModel& line = model.line[l];
  if (!acts_on(c, i, line)) return 0.;
  if (model.form == Form::condensed) return line_under(model, w, c, line, i, by.first, by.second);
  const double* const half = w.unit + i * std::ptrdiff_t{model.unknowns};
  return panels_dot(common(c.panels[i][l], by.panels), half + line.first, by.second + line.first);
}

namespace {

/// Adds the compliance of a line to W by the responses to each wheel.
void add_summed(const Model& model, const Workspace& w, std::int32_t l, Coupling& c) noexcept {
  for (int j = 0; j < c.rows; ++j) {
    if (!acts_on(c, j, model.line[l])) continue;
    const std::ptrdiff_t unit = j * std::ptrdiff_t{model.unknowns};
    const LineResponse by{c.panels[j][l], w.unit + unit, w.unit_second + unit};
    for (int i = j; i < c.rows; ++i) c.W[i * c.ports + j] += line_compliance(model, w, c, i, l, by);
  }
}

}  // namespace

void track_compliance(const Model& model, const Workspace& w, Coupling& c) noexcept {
  for (int i = 0; i < c.rows; ++i)
    for (int j = 0; j <= i; ++j) c.W[i * c.ports + j] = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l)
    if (model.form == Form::condensed && model.line[l].modal.between != nullptr)
      add_tabled(model.line[l], c);
    else
      add_summed(model, w, l, c);
}

double track_motion(const Model& model, const Workspace& w, const Coupling& c, int i) noexcept {
  if (model.form == Form::condensed)
    return track_under(model, w, c, i, w.solved, w.imaginary) - c.located[i];
  double sum = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l)
    sum += line_compliance(model, w, c, i, l, {c.panels[i][l], nullptr, w.solved});
  return sum - c.located[i];
}

void move_track(const Model& model, Workspace& w, const Coupling& c) noexcept {
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineModel& line = model.line[l];
    const double *re[kMaxTrackRows], *im[kMaxTrackRows];
    double force[kMaxTrackRows];
    int count = 0;
    for (int i = 0; i < c.rows; ++i) {
      if (!acts_on(c, i, line)) continue;
      const std::ptrdiff_t unit = i * std::ptrdiff_t{model.unknowns} + line.first;
      if (model.form == Form::banded)
        panels_subtract(c.panels[i][l], c.force[i], w.unit_second + unit, w.solved + line.first);
      re[count] = w.unit + unit;
      im[count] = w.unit_second + unit;
      force[count++] = c.force[i];
    }
    if (model.form == Form::banded) continue;
    subtract(re, force, count, line.size, w.solved + line.first);
    subtract(im, force, count, line.size, w.imaginary + line.first);
  }
}

void finish_track(const Model& model, Workspace& w) noexcept {
  if (model.form == Form::condensed) return;
  for (std::int32_t l = 0; l < model.lines; ++l)
    solve_backward(model.line[l].step, w.solved + model.line[l].first);
}

}  // namespace railstep
