#include "online/contact/external.h"

#include <cmath>

#include "online/model/external_input.h"
#include "online/model/progress.h"
#include "online/track/p_delta.h"

namespace railstep {

namespace {

/// Roll of the section under a point, rad.
double roll_under(const Model& model, const RailRow& place, const double* shape,
                  const Configuration& at) noexcept {
  RailRow row{};
  row.rail = place.rail;
  row.element = place.element;
  for (int i = 0; i < 3; ++i) {
    row.coefficient[i][5] = .5 * shape[i];
    row.coefficient[i][7] = -.5 * shape[i];
  }
  double roll = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l) roll += motion(model.line[l], row, at);
  return roll;
}

/// Rows of the point (y, z) of the section along the track's axes.
void fill_rows(const Cant& cant, const double* shape, double y, double z,
               ExternalContact& at) noexcept {
  const double lever[3] = {1., y, z};
  for (int d = 0; d < 3; ++d) {
    double axis[3] = {0., 0., 0.}, along[3];
    axis[d] = 1.;
    to_rail(cant, axis, along);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 9; ++k)
        at.row[d].coefficient[i][k] = shape[i] * (lever[k / 3] * along[k % 3]);
  }
}

void place_wheel(const Model& model, const ExternalWheelModel& wheel, std::int64_t step,
                 const double* input, const Configuration& located, ExternalContact& at) noexcept {
  at = ExternalContact{};
  const double* own = input + wheel.input;
  at.place = own[kExternalX] - track_offset(model, step);
  const double scaled = at.place / model.element_length;
  const double radius = model.crown_radius[wheel.rail], half = model.head_half_width[wheel.rail];
  at.on_rail = scaled >= 0. && scaled <= model.elements && std::fabs(own[kExternalY]) <= half;
  at.port.load_point = kNoLoadPoint;
  if (!at.on_rail) return;
  std::int32_t element = static_cast<std::int32_t>(scaled);
  if (element == model.elements) element = model.elements - 1;
  const double xi = 2. * (scaled - element) - 1.;
  const Cant& cant = model.cant[wheel.rail];
  const CrownTop top = crown_top(cant, model.head_z[wheel.rail], radius);
  const double y = top.y + own[kExternalY];  // on the crown's circle
  const double z = (model.head_z[wheel.rail] - radius) + std::sqrt(radius * radius - y * y);
  double shape[3];
  shape_functions(xi, shape);
  for (RailRow& row : at.row) {
    row.rail = wheel.rail;
    row.element = element;
  }
  fill_rows(cant, shape, y, z, at);
  const double up[3] = {0., 0., 1.}, roll = roll_under(model, at.row[2], shape, located);
  at.roll = roll;
  double along[3];
  to_rail(cant, up, along);
  SeatMotions seats;
  const double higher = add_p_delta(model, located, roll, xi, y, z, up, at.row[2], seats);
  at.offset = .5 * roll * roll * (z * along[2] + y * along[1]) - higher;
  for (int d = 0; d < 3; ++d) at.force[d] = own[kExternalForce + d];
  at.port = {model, wheel.load_point, element, xi, at.force[2]};
}

/// Response of the lines to a unit force along a row: of condensed ones to a force held over the
/// step, into w.solved and w.imaginary; of banded ones at its end, into w.solved.
void respond(const Model& model, const RailRow& row, Workspace& w) noexcept {
  if (model.form == Form::banded) {
    for (std::int32_t i = 0; i < model.line_unknowns; ++i) w.solved[i] = 0.;
    for (std::int32_t l = 0; l < model.lines; ++l) {
      spread(model.line[l], row, 1., w.solved);
      solve_band(model.line[l].step, w.solved + model.line[l].first);
    }
    return;
  }
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineModel& line = model.line[l];
    shape_row(line, row, w.u_star, w.v_star);
    modes_multiply(line.modal.held_force, {w.u_star + line.first, w.v_star + line.first},
                   w.solved + line.first, w.imaginary + line.first, line.size);
  }
}

/// Applies a force along a row to condensed lines.
void apply_to_modes(const Model& model, const RailRow& row, double force, Workspace& w) noexcept {
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineModel& line = model.line[l];
    shape_row(line, row, w.u_star, w.v_star);
    const double *re = w.u_star + line.first, *im = w.v_star + line.first;
    const Complex held = line.modal.held_force;
    double *z_re = w.solved + line.first, *z_im = w.imaginary + line.first;
#pragma omp simd
    for (std::int32_t k = 0; k < line.size; ++k) {
      z_re[k] += force * (held.re[k] * re[k] - held.im[k] * im[k]);
      z_im[k] += force * (held.re[k] * im[k] + held.im[k] * re[k]);
    }
  }
}

/// Rates of modes without the part of the forces: rate z into w.u_star and w.v_star. That part
/// moves no point, as the sum of shape shape' over the modes is 0: displacements of one instant
/// contain no forces.
void mode_rates(const Model& model, const State& s, Workspace& w) noexcept {
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineModel& line = model.line[l];
    modes_multiply(line.modal.rate, {s.u + line.first, s.v + line.first}, w.u_star + line.first,
                   w.v_star + line.first, line.size);
  }
}

/// Displacement of a contact's point by the lines, without terms of second order.
double moved(const Model& model, const RailRow& row, const Configuration& at) noexcept {
  double sum = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l) sum += motion(model.line[l], row, at);
  return sum;
}

}  // namespace

void place_external(const Model& model, std::int64_t step, const double* input,
                    const Configuration& located, ExternalContact* contact) noexcept {
  for (std::int32_t n = 0; n < model.external_wheels; ++n)
    place_wheel(model, model.external_wheel[n], step, input, located, contact[n]);
}

void place_in_step(const Model& model, std::int64_t step, const State& s, double* scaled,
                   ExternalContact* contact) noexcept {
  const double dt = model.form == Form::condensed ? 0. : model.scheme.dt;  // located as wheels are
#pragma omp simd
  for (std::int32_t i = 0; i < model.line_unknowns; ++i) scaled[i] = s.u[i] + dt * s.v[i];
  place_external(model, step, s.input, {scaled, {s.u, s.v}}, contact);
}

void apply_external_forces(const Model& model, std::int64_t step, const State& s, Workspace& w,
                           ExternalContact* contact) noexcept {
  place_in_step(model, step, s, w.scaled, contact);
  for (std::int32_t n = 0; n < model.external_wheels; ++n)
    for (int d = 0; d < 3 && contact[n].on_rail; ++d) {
      const ExternalContact& at = contact[n];
      if (model.form == Form::condensed)
        apply_to_modes(model, at.row[d], at.force[d], w);
      else
        for (std::int32_t l = 0; l < model.lines; ++l)
          spread(model.line[l], at.row[d], at.force[d], w.solved);
    }
}

void publish_external(const Model& model, const State& s, const ExternalContact* contact,
                      Outputs& outputs) noexcept {
  for (std::int32_t n = 0; n < model.external_wheels; ++n) {
    const ExternalContact& at = contact[n];
    outputs.external_on_rail[n] = at.on_rail;
    outputs.external_place[n] = at.place;
    outputs.external_force[n] = at.force[2];
    if (!at.on_rail) outputs.status = outputs.status | Status::off_rail;
    if (at.roll * at.roll > kLargeRollSquared) outputs.status = outputs.status | Status::large_turn;
    for (int d = 0; d < 3; ++d)
      outputs.external_displacement[n][d] =
          at.on_rail ? moved(model, at.row[d], {s.u, {s.u, s.v}}) + (d == 2 ? at.offset : 0.) : 0.;
  }
}

void publish_external_rates(const Model& model, const State& s, const ExternalContact* contact,
                            Workspace& w, Outputs& outputs) noexcept {
  if (model.form == Form::condensed) mode_rates(model, s, w);
  for (std::int32_t n = 0; n < model.external_wheels; ++n)
    for (int d = 0; d < 3; ++d)
      outputs.external_velocity[n][d] =
          contact[n].on_rail ? moved(model, contact[n].row[d], {s.v, {w.u_star, w.v_star}}) : 0.;
}

void external_compliance(const Model& model, const ExternalContact* contact, Workspace& w,
                         double* compliance) noexcept {
  const std::int32_t count = external_row(model.external_wheels, 0);
  for (std::int32_t j = 0; j < count; ++j) {
    const auto [source, along] = external_row_at(j);
    const ExternalContact& from = contact[source];
    if (from.on_rail) respond(model, from.row[along], w);
    for (std::int32_t i = 0; i <= j; ++i) {
      const auto [wheel, direction] = external_row_at(i);
      const ExternalContact& at = contact[wheel];
      double sum = 0.;
      const bool both = from.on_rail && at.on_rail;
      if (both) sum = moved(model, at.row[direction], {w.solved, {w.solved, w.imaginary}});
      if (both && direction == 2 && along == 2)
        sum +=
            i == j ? residual_under(model, at.port) : residual_between(model, from.port, at.port);
      compliance[i * count + j] = compliance[j * count + i] = sum;
    }
  }
}

}  // namespace railstep
