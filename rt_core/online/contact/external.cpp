#include "online/contact/external.h"

#include <cmath>

#include "online/model/external_input.h"
#include "online/model/progress.h"
#include "online/track/p_delta.h"
#include "online/track/rail_point.h"

namespace railstep {

namespace {

void place_wheel(const Model& model, const ExternalWheelModel& wheel, std::int64_t step,
                 const double* input, const Configuration& located, ExternalContact& at) noexcept {
  at = ExternalContact{};
  const double* own = input + wheel.input;
  at.place = own[kExternalX] - track_offset(model, step);
  const PlaceOnRails place = place_on_rails(model, at.place);
  const double radius = model.crown_radius[wheel.rail], half = model.head_half_width[wheel.rail];
  at.on_rail = place.on_rail && std::fabs(own[kExternalY]) <= half;
  at.port.load_point = kNoLoadPoint;
  if (!at.on_rail) return;
  const Cant& cant = model.cant[wheel.rail];
  const CrownTop top = crown_top(cant, model.head_z[wheel.rail], radius);
  const double y = top.y + own[kExternalY];  // on the crown's circle
  const double z = (model.head_z[wheel.rail] - radius) + std::sqrt(radius * radius - y * y);
  double shape[3];
  shape_functions(place.xi, shape);
  RailRow of_roll{};
  of_roll.rail = wheel.rail;
  of_roll.element = place.element;
  for (int d = 0; d < 3; ++d) {
    at.row[d] = of_roll;
    double axis[3] = {0., 0., 0.};
    axis[d] = 1.;
    set_point_row(cant, y, z, shape, axis, at.row[d]);
  }
  set_roll_row(shape, of_roll);
  const double roll = at.roll = motion(model, of_roll, located);
  double along[3];
  to_rail(cant, kUp, along);
  SeatMotions seats;
  const double higher = add_p_delta(model, located, roll, place.xi, y, z, kUp, at.row[2], seats);
  at.offset = .5 * roll * roll * (z * along[2] + y * along[1]) - higher;
  for (int d = 0; d < 3; ++d) at.force[d] = own[kExternalForce + d];
  at.port = {model, wheel.load_point, place.element, place.xi, at.force[2]};
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
          at.on_rail ? motion(model, at.row[d], {s.u, {s.u, s.v}}) + (d == 2 ? at.offset : 0.) : 0.;
  }
}

void publish_external_rates(const Model& model, const State& s, const ExternalContact* contact,
                            Workspace& w, Outputs& outputs) noexcept {
  if (model.form == Form::condensed) mode_rates(model, s, w);
  for (std::int32_t n = 0; n < model.external_wheels; ++n)
    for (int d = 0; d < 3; ++d)
      outputs.external_velocity[n][d] =
          contact[n].on_rail ? motion(model, contact[n].row[d], {s.v, {w.u_star, w.v_star}}) : 0.;
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
      if (both) sum = motion(model, at.row[direction], {w.solved, {w.solved, w.imaginary}});
      if (both && direction == 2 && along == 2)
        sum +=
            i == j ? residual_under(model, at.port) : residual_between(model, from.port, at.port);
      compliance[i * count + j] = compliance[j * count + i] = sum;
    }
  }
}

}  // namespace railstep
