#include "online/contact/fixed_port_force.h"

#include "online/contact/track_response.h"
#include "online/track/closing.h"

namespace railstep {

namespace {

/// What a unit force of a port makes of the lines; the imaginary parts of condensed ones alone.
Complex response_of(const Model& model, std::int32_t port) noexcept {
  const std::ptrdiff_t stride = std::ptrdiff_t{parts(model.form)} * model.line_unknowns;
  const double* re = model.fixed.response + port * stride;
  return {re, re + modal_unknowns(model)};
}

/// The law of a step for given kv and v0.
PortLaw law_of(const FixedPortModel& fixed, std::int32_t port, double kv, double v0) noexcept {
  return {0., fixed.stiffness[port] + fixed.damping[port] * kv, fixed.damping[port] * v0};
}

void place_banded(const Model& model, std::int32_t j, const Workspace& w, Coupling& c) noexcept {
  const FixedPortModel& fixed = model.fixed;
  const double kv = model.scheme.kv;
  const double v0 =
      (closing(model, j, w.v_star, nullptr) - kv * closing(model, j, w.u_star, nullptr)) +
      kv * fixed.gap[j];
  c.law[c.wheels + j] = law_of(fixed, j, kv, v0);
  c.track_free[c.wheels + j] = closing(model, j, w.solved, nullptr) - fixed.gap[j];
}

void place_condensed(const Model& model, std::int32_t j, const State& s, const Workspace& w,
                     Coupling& c) noexcept {
  const FixedPortModel& fixed = model.fixed;
  const double theta = model.scheme.theta, kv = 1. / (theta * model.scheme.dt);
  const double d0 = closing(model, j, s.u, s.v) - fixed.gap[j];
  const double d1 = closing(model, j, w.solved, w.imaginary) - fixed.gap[j];
  c.law[c.wheels + j] = law_of(fixed, j, kv, -kv * d0);
  c.track_free[c.wheels + j] = theta * d1 + (1. - theta) * d0;
}

/// W between a fixed port and all before it.
void fixed_compliance(const Model& model, std::int32_t j, const Workspace& w,
                      Coupling& c) noexcept {
  const Complex response = response_of(model, j);
  const int row = c.wheels + j;
  for (int i = 0; i < c.wheels; ++i) {
    const double sum =
        c.contact[i].on_rail
            ? model.scheme.theta * track_under(model, w, c, i, response.re, response.im)
            : 0.;
    c.W[i * c.ports + row] = c.W[row * c.ports + i] = sum;
  }
  for (std::int32_t i = 0; i <= j; ++i)
    c.W[(c.wheels + i) * c.ports + row] = c.W[row * c.ports + c.wheels + i] =
        model.fixed.compliance[j * model.fixed.count + i];
}

}  // namespace

void couple_fixed_ports(const Model& model, const State& s, const Workspace& w,
                        Coupling& c) noexcept {
  for (std::int32_t j = 0; j < model.fixed.count; ++j) {
    if (model.form == Form::condensed)
      place_condensed(model, j, s, w, c);
    else
      place_banded(model, j, w, c);
    fixed_compliance(model, j, w, c);
    c.force[c.wheels + j] = s.port_force[j];
  }
}

void press_fixed_ports(const Model& model, const Coupling& c, State& s, Workspace& w) noexcept {
  for (std::int32_t j = 0; j < model.fixed.count; ++j) {
    const Complex response = response_of(model, j);
    const double force = c.force[c.wheels + j];
    s.port_force[j] = force;
#pragma omp simd
    for (std::int32_t k = 0; k < model.line_unknowns; ++k) w.solved[k] -= force * response.re[k];
    if (model.form == Form::banded) continue;
#pragma omp simd
    for (std::int32_t k = 0; k < model.line_unknowns; ++k) w.imaginary[k] -= force * response.im[k];
  }
}

}  // namespace railstep
