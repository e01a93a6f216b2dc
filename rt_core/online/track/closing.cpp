#include "online/track/closing.h"

namespace railstep {

namespace {

Complex shape_of(const Model& model, std::int32_t port) noexcept {
  const double* re =
      model.fixed.shape + 2 * static_cast<std::ptrdiff_t>(port) * model.line_unknowns;
  return {re, re + model.line_unknowns};
}

}  // namespace

double closing(const Model& model, std::int32_t port, const double* re, const double* im) noexcept {
  if (model.form == Form::condensed)
    return modes_dot(shape_of(model, port), {re, im}, model.line_unknowns);
  const FixedPortModel& fixed = model.fixed;
  double sum = 0.;
  for (std::int32_t k = fixed.start[port]; k < fixed.start[port + 1]; ++k)
    sum += fixed.value[k] * re[fixed.index[k]];
  return sum;
}

double closing_speed(const Model& model, std::int32_t port, const State& s) noexcept {
  if (model.form == Form::banded) return closing(model, port, s.v, nullptr);
  // Re shape (rate z): the part of z' by forces does not move the row (completeness).
  const Complex shape = shape_of(model, port);
  double sum = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineModel& line = model.line[l];
    for (std::int32_t k = 0; k < line.size; ++k) {
      const std::int32_t at = line.first + k;
      const double re = line.modal.rate.re[k] * s.u[at] - line.modal.rate.im[k] * s.v[at];
      const double im = line.modal.rate.re[k] * s.v[at] + line.modal.rate.im[k] * s.u[at];
      sum += shape.re[at] * re - shape.im[at] * im;
    }
  }
  return sum;
}

}  // namespace railstep
