#include "online/contact/track_response.h"

namespace railstep {

namespace {

/// The part of one line in a wheel's row.
Complex row_of(const Model& model, const Workspace& w, const LineModel& line,
               ContactId wheel) noexcept {
  const double* re = w.row + 2 * static_cast<std::ptrdiff_t>(wheel) * model.unknowns + line.first;
  return {re, re + model.unknowns};
}

/// Whether a force at the wheel moves the line.
bool acts_on(const Coupling& c, ContactId wheel, const LineModel& line) noexcept {
  return c.contact[wheel].on_rail && line.rail_factor[c.contact[wheel].row.rail] != 0.;
}

/// Solves each banded line for its own forces and for the wheels that act on it, if possible
/// together.
void solve_bands(const Model& model, Workspace& w, const Coupling& c) noexcept {
  const std::ptrdiff_t stride = model.unknowns;
  for (ContactId i = 0; i < c.contacts; ++i) {
    double* rhs = w.unit + i * stride;
    for (std::int32_t k = 0; k < model.line_unknowns; ++k) rhs[k] = 0.;
    if (!c.contact[i].on_rail) continue;
    for (std::int32_t l = 0; l < model.lines; ++l) spread(model.line[l], c.contact[i].row, 1., rhs);
  }
  for (std::int32_t l = 0; l < model.lines; ++l) {
    double* x = w.solved + model.line[l].first;
    double* unit = w.unit + model.line[l].first;
    const bool both = model.line[l].rail_factor[0] != 0. && model.line[l].rail_factor[1] != 0.;
    const int together = both && c.contacts >= 2 ? 2 : 0;
    if (together == 2)
      solve_band<3>(model.line[l].step, x, stride);
    else
      solve_band<1>(model.line[l].step, x, stride);
    for (int i = together; i < c.contacts; ++i)
      if (c.contact[i].on_rail && model.line[l].rail_factor[c.contact[i].row.rail] != 0.)
        solve_band<1>(model.line[l].step, unit + i * stride, stride);
  }
}

/// Response of the condensed lines to a unit force under each wheel, held over the step.
void respond_modes(const Model& model, Workspace& w, const Coupling& c) noexcept {
  const std::ptrdiff_t stride = model.unknowns;
  for (ContactId i = 0; i < c.contacts; ++i) {
    double* re = w.row + 2 * i * stride;
    const std::ptrdiff_t unit = i * stride;
    for (std::int32_t l = 0; l < model.lines; ++l) {
      const LineModel& line = model.line[l];
      if (!acts_on(c, i, line)) continue;
      shape_row(line, c.contact[i].row, re, re + stride);
      modes_multiply(line.modal.held_force, row_of(model, w, line, i), w.unit + unit + line.first,
                     w.unit_imaginary + unit + line.first, line.size);
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
                  ContactId i, const double* re, const double* im) noexcept {
  if (model.form == Form::banded) return motion(line, c.contact[i].row, {re, {}});
  return modes_dot(row_of(model, w, line, i), {re + line.first, im + line.first}, line.size);
}

}  // namespace

void respond(const Model& model, const State& s, Workspace& w, Coupling& c) noexcept {
  if (model.form == Form::condensed)
    respond_modes(model, w, c);
  else
    solve_bands(model, w, c);
  for (ContactId i = 0; i < c.contacts; ++i)
    c.located[i] = model.form == Form::condensed ? track_under(model, w, c, i, s.u, s.v)
                                                 : track_under(model, w, c, i, w.scaled, nullptr);
}

double track_under(const Model& model, const Workspace& w, const Coupling& c, ContactId i,
                   const double* re, const double* im) noexcept {
  double sum = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l)
    if (acts_on(c, i, model.line[l])) sum += line_under(model, w, c, model.line[l], i, re, im);
  return sum;
}

double track_compliance(const Model& model, const Workspace& w, const Coupling& c, ContactId i,
                        ContactId j) noexcept {
  const std::ptrdiff_t unit = static_cast<std::ptrdiff_t>(j) * model.unknowns;
  double sum = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l)
    if (acts_on(c, i, model.line[l]) && acts_on(c, j, model.line[l]))
      sum += line_under(model, w, c, model.line[l], i, w.unit + unit, w.unit_imaginary + unit);
  return sum;
}

double track_motion(const Model& model, const Workspace& w, const Coupling& c,
                    ContactId i) noexcept {
  return track_under(model, w, c, i, w.solved, w.imaginary) - c.located[i];
}

void move_track(const Model& model, Workspace& w, const Coupling& c) noexcept {
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineModel& line = model.line[l];
    const double *re[kMaxWheels], *im[kMaxWheels];
    double force[kMaxWheels];
    int count = 0;
    for (ContactId i = 0; i < c.contacts; ++i) {
      if (!acts_on(c, i, line)) continue;
      const std::ptrdiff_t unit = static_cast<std::ptrdiff_t>(i) * model.unknowns + line.first;
      re[count] = w.unit + unit;
      im[count] = w.unit_imaginary + unit;
      force[count++] = c.force[i];
    }
    subtract(re, force, count, line.size, w.solved + line.first);
    if (model.form == Form::condensed)
      subtract(im, force, count, line.size, w.imaginary + line.first);
  }
}

}  // namespace railstep
