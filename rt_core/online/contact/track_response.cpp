#include "online/contact/track_response.h"

namespace railstep {

namespace {

/// The part of one line in a base.
Complex base_of(const Model& model, const Workspace& w, const LineModel& line, int base) noexcept {
  const double* re = w.row + 2 * static_cast<std::ptrdiff_t>(base) * model.unknowns + line.first;
  return {re, re + model.unknowns};
}

/// The response to a unit force along a base, unless there is a table.
void hold_base(const Model& model, const LineModel& line, int base, Workspace& w) noexcept {
  if (is_tabled(line)) return;
  const std::ptrdiff_t unit = base * std::ptrdiff_t{model.unknowns} + line.first;
  modes_multiply(line.modal.held_force, base_of(model, w, line, base), w.unit + unit,
                 w.unit_second + unit, line.size);
}

/// Halfway solve of a banded line for a base.
/// @param unit  where the base's responses begin in the workspace
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

/// Halfway solves of each banded line: of its own right-hand side, and of each base in the panels
/// that it reaches.
void respond_bands(const Model& model, Workspace& w, Coupling& c) noexcept {
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const Band& step = model.line[l].step;
    double* const own = w.solved + model.line[l].first;
    solve_forward(step, {0, step.panels}, own);
    divide_by_pivots(step, {0, step.panels}, own);
  }
  for (int i = 0; i < c.bases; ++i)
    for (std::int32_t l = 0; l < model.lines; ++l) {
      const LineModel& line = model.line[l];
      if (c.acts[i][l])
        respond_band(line, base_row(c, i), i * std::ptrdiff_t{model.unknowns}, w, c.panels[i][l]);
    }
}

/// The shape of a base in a line, and unless there is a table the response to a unit force along
/// it, held over the step.
void shape_base(const Model& model, const LineModel& line, int base, Workspace& w,
                const Coupling& c) noexcept {
  double* const re = w.row + 2 * static_cast<std::ptrdiff_t>(base) * model.unknowns;
  shape_row(line, base_row(c, base), re, re + model.unknowns);
  hold_base(model, line, base, w);
}

/// Bases by the levers of both rails under a wheelset: the rolls over seats move them.
/// @param left  that of the left rail
void respond_levers(const Model& model, const State& s, Workspace& w, Coupling& c,
                    int left) noexcept {
  TwoMotions roll[2][kPDeltaSeats] = {};
  const RailRow& row = base_row(c, left);
  for (std::int32_t l = 0; l < model.lines; ++l) {
    if (!c.acts[left][l]) continue;
    TwoMotions own[kPDeltaSeats];
    move_rolls(model.line[l], row, {s.u, s.v}, {w.solved, w.imaginary}, own);
    const double right = right_roll(model.line[l]);
    for (std::int32_t k = 0; k < row.seats; ++k) {
      roll[0][k].first += own[k].first;
      roll[0][k].second += own[k].second;
      roll[1][k].first += right * own[k].first;
      roll[1][k].second += right * own[k].second;
    }
  }
  for (int side = 0; side < 2; ++side) {
    RailRow& levers = c.seat[seat_of_base(c, left + side)].row;
    const int z = rows_of_base(c, left + side, model.line[0]).row[0];
    c.seat[z - c.contacts].rise = -lean_on_seats(roll[side], 1., levers);
    for (std::int32_t k = 0; k < levers.seats; ++k) {
      c.located[z] += levers.lever[k] * roll[side][k].first;
      c.moved[z] += levers.lever[k] * roll[side][k].second;
    }
    for (std::int32_t l = 0; l < model.lines; ++l)
      if (c.acts[left + side][l] && (c.shapes_levers || !is_tabled(model.line[l])))
        shape_base(model, model.line[l], left + side, w, c);
  }
}

/// Shapes of the bases in condensed lines, and their responses. Displacements of the lines along
/// all rows, as they are located and without contact forces at the step's end, go to `located` and
/// `moved`.
void respond_modes(const Model& model, const State& s, Workspace& w, Coupling& c) noexcept {
  const std::ptrdiff_t stride = model.unknowns;
  for (int i = 0; i < c.rows; ++i) c.located[i] = c.moved[i] = 0.;
  for (int i = 0; i < c.bases; ++i) {
    if (is_by_levers(c, i)) {  // the next base is that of the right rail
      respond_levers(model, s, w, c, i++);
      continue;
    }
    double* re = w.row + 2 * i * stride;
    for (std::int32_t l = 0; l < model.lines; ++l) {
      const LineModel& line = model.line[l];
      if (!c.acts[i][l]) continue;
      const TwoMotions own = shape_moving_row(line, base_row(c, i), {s.u, s.v},
                                              {w.solved, w.imaginary}, re, re + stride);
      add_to_rows(c, i, line, own.first, c.located);
      add_to_rows(c, i, line, own.second, c.moved);
      hold_base(model, line, i, w);
    }
  }
  lean_rows(c, c.located);
  lean_rows(c, c.moved);
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

/// Adds a panel of four vectors times forces, so that the sums are read and written less often.
void add_four(const double* a, const double* b, const double* c, const double* d,
              const double* force, double* sum) noexcept {
  const double f0 = force[0], f1 = force[1], f2 = force[2], f3 = force[3];
#pragma omp simd
  for (int l = 0; l < kLanes; ++l)
    sum[l] = (((sum[l] + f0 * a[l]) + f1 * b[l]) + f2 * c[l]) + f3 * d[l];
}

/// x -= forces times the shapes of a line, as they move it when held over the step.
void subtract_held(const Complex& held, const Complex* shape, const double* force, int count,
                   int size, double* re, double* im) noexcept {
  for (int k = 0; k < size; k += kLanes) {
    double sum_re[kLanes] = {}, sum_im[kLanes] = {};
    int i = 0;
    for (; i + 4 <= count; i += 4) {
      const Complex* const own = shape + i;
      add_four(own[0].re + k, own[1].re + k, own[2].re + k, own[3].re + k, force + i, sum_re);
      add_four(own[0].im + k, own[1].im + k, own[2].im + k, own[3].im + k, force + i, sum_im);
    }
    for (; i < count; ++i) {
#pragma omp simd
      for (int l = 0; l < kLanes; ++l) {
        sum_re[l] += force[i] * shape[i].re[k + l];
        sum_im[l] += force[i] * shape[i].im[k + l];
      }
    }
#pragma omp simd
    for (int l = 0; l < kLanes; ++l) {
      re[k + l] -= held.re[k + l] * sum_re[l] - held.im[k + l] * sum_im[l];
      im[k + l] -= held.re[k + l] * sum_im[l] + held.im[k + l] * sum_re[l];
    }
  }
}

}  // namespace

double shape_under(const Model& model, const Workspace& w, const Coupling& c, int base,
                   std::int32_t l, const double* re, const double* im) noexcept {
  const LineModel& line = model.line[l];
  if (model.form == Form::banded) return motion(line, base_row(c, base), {re, {}});
  return modes_dot(base_of(model, w, line, base), {re + line.first, im + line.first}, line.size);
}

void respond(const Model& model, const State& s, Workspace& w, Coupling& c) noexcept {
  if (model.form == Form::condensed) return respond_modes(model, s, w, c);
  respond_bands(model, w, c);
  const auto under = [&](int base, std::int32_t, const LineModel& line) noexcept {
    return motion(line, base_row(c, base), {w.scaled, {}});
  };
  sum_rows(model, c, under, c.located);
}

double line_compliance(const Model& model, const Workspace& w, const Coupling& c, int base,
                       std::int32_t l, const LineResponse& by) noexcept {
  const LineModel& line = model.line[l];
  if (model.form == Form::condensed) return shape_under(model, w, c, base, l, by.first, by.second);
  const double* const half = w.unit + base * std::ptrdiff_t{model.unknowns};
  return panels_dot(common(c.panels[base][l], by.panels), half + line.first,
                    by.second + line.first);
}

void find_track_motion(const Model& model, const Workspace& w, Coupling& c) noexcept {
  const auto under = [&](int base, std::int32_t l, const LineModel&) noexcept {
    return line_compliance(model, w, c, base, l, {c.panels[base][l], nullptr, w.solved});
  };
  if (model.form == Form::banded) sum_rows(model, c, under, c.moved);
  for (int i = 0; i < c.rows; ++i) c.moved[i] -= c.located[i];
}

namespace {

/// Shapes that a line is moved along, at most.
constexpr int kMostMoved = kMaxWheels + kMaxSeatedWheelsets * (kWheelSeatRows + kMostRollParts);

/// The forces on a line along the rolls over seats by the levers of both rails.
/// @param left   base of those of the left rail
/// @param shape, force  [kMostRollParts] out
/// @returns their number
int add_roll_forces(const LineModel& line, const double* row_force, const Coupling& c, int left,
                    Complex* shape, double* force) noexcept {
  const RailRow &own = base_row(c, left), &other = base_row(c, left + 1);
  const double of_left = row_force[rows_of_base(c, left, line).row[0]],
               of_right = right_roll(line) * row_force[rows_of_base(c, left + 1, line).row[0]];
  RollPart part[kMostRollParts];
  const int count = roll_parts(line, own, part);
  for (int i = 0; i < count; ++i) {
    const std::int32_t s = part[i].seat;
    shape[i] = part[i].shape;
    force[i] = part[i].weight * (of_left * own.lever[s] + of_right * other.lever[s]);
  }
  return count;
}

}  // namespace

void move_track(const Model& model, Workspace& w, const Coupling& c) noexcept {
  double row_force[kMaxTrackRows];
  for (int i = 0; i < c.rows; ++i) row_force[i] = c.force[i];
  for (int i = c.contacts; i < c.rows; i += kWheelSeatRows)
    for (int d = 0; d < 2; ++d)
      row_force[i + 2] -= c.seat[i + d - c.contacts].lean * row_force[i + d];
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineModel& line = model.line[l];
    const double *re[kMaxTrackRows], *im[kMaxTrackRows];
    Complex shape[kMostMoved];
    double force[kMostMoved];
    int count = 0;
    for (int i = 0; i < c.bases; ++i) {
      if (!c.acts[i][l]) continue;
      if (is_by_levers(c, i) && is_tabled(line) && !c.shapes_levers) {
        count += add_roll_forces(line, row_force, c, i++, shape + count, force + count);
        continue;
      }
      const std::ptrdiff_t unit = i * std::ptrdiff_t{model.unknowns} + line.first;
      const RowsOfBase rows = rows_of_base(c, i, line);
      double own = 0.;
      for (int k = 0; k < rows.count; ++k) own += rows.factor[k] * row_force[rows.row[k]];
      if (model.form == Form::banded)
        panels_subtract(c.panels[i][l], own, w.unit_second + unit, w.solved + line.first);
      else
        shape[count] = base_of(model, w, line, i);
      re[count] = w.unit + unit;
      im[count] = w.unit_second + unit;
      force[count++] = own;
    }
    if (model.form == Form::banded) continue;
    double *const of_re = w.solved + line.first, *const of_im = w.imaginary + line.first;
    if (is_tabled(line)) {
      subtract_held(line.modal.held_force, shape, force, count, line.size, of_re, of_im);
      continue;
    }
    subtract(re, force, count, line.size, of_re);
    subtract(im, force, count, line.size, of_im);
  }
}

void finish_track(const Model& model, Workspace& w) noexcept {
  if (model.form == Form::condensed) return;
  for (std::int32_t l = 0; l < model.lines; ++l)
    solve_backward(model.line[l].step, w.solved + model.line[l].first);
}

}  // namespace railstep
