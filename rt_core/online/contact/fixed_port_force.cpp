#include "online/contact/fixed_port_force.h"

#include "online/contact/damper.h"
#include "online/contact/track_response.h"
#include "online/track/closing.h"

namespace railstep {

namespace {

/// Response of the lines to a unit force of a port.
LineResponse response_of(const Model& model, std::int32_t port, std::int32_t line) noexcept {
  const double* first =
      model.fixed.response + 2 * static_cast<std::ptrdiff_t>(port) * model.line_unknowns;
  if (model.form == Form::condensed) return {{}, first, first + model.line_unknowns};
  const std::int32_t* panels =
      model.fixed.panels + 2 * (static_cast<std::ptrdiff_t>(port) * model.lines + line);
  return {{panels[0], panels[1]}, first, first + model.line_unknowns};
}

PortLaw law_of(const FixedPortModel& fixed, std::int32_t port, const DepthSpeed& speed) noexcept {
  PortLaw law{0., fixed.stiffness[port], 0.};
  add_damper(fixed.damping[port], speed, law);
  return law;
}

void place_banded(const Model& model, std::int32_t j, const Workspace& w, Coupling& c) noexcept {
  const FixedPortModel& fixed = model.fixed;
  DepthSpeed speed = speed_at_end(model.scheme, closing(model, j, w.u_star, nullptr),
                                  closing(model, j, w.v_star, nullptr));
  speed.before += speed.per_metre * fixed.gap[j];  // the depth is the closing less the gap
  c.law[c.contacts + j] = law_of(fixed, j, speed);
  double free = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineResponse own = response_of(model, j, l);
    const std::int32_t first = model.line[l].first;
    free += panels_dot(own.panels, own.first + first, w.solved + first);
  }
  c.track_free[c.rows + j] = free - fixed.gap[j];
}

void place_condensed(const Model& model, std::int32_t j, const State& s, const Workspace& w,
                     Coupling& c) noexcept {
  const FixedPortModel& fixed = model.fixed;
  const double theta = model.scheme.theta;
  const double d0 = closing(model, j, s.u, s.v) - fixed.gap[j];
  const double d1 = closing(model, j, w.solved, w.imaginary) - fixed.gap[j];
  c.law[c.contacts + j] = law_of(fixed, j, mean_speed(model.scheme, d0));
  c.track_free[c.rows + j] = theta * d1 + (1. - theta) * d0;
}

/// W between a fixed port and all before it.
void fixed_compliance(const Model& model, std::int32_t j, const Workspace& w,
                      Coupling& c) noexcept {
  const int row = c.rows + j;
  double by_port[kMaxTrackRows];
  const auto under = [&](int base, std::int32_t l, const LineModel&) noexcept {
    return line_compliance(model, w, c, base, l, response_of(model, j, l));
  };
  sum_rows(model, c, under, by_port);
  for (int i = 0; i < c.rows; ++i)
    c.W[i * c.ports + row] = c.W[row * c.ports + i] = model.scheme.theta * by_port[i];
  for (std::int32_t i = 0; i <= j; ++i)
    c.W[(c.rows + i) * c.ports + row] = c.W[row * c.ports + c.rows + i] =
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
    c.force[c.rows + j] = s.port_force[j];
  }
}

void apply_fixed_port_forces(const Model& model, const Coupling& c, State& s,
                             Workspace& w) noexcept {
  for (std::int32_t j = 0; j < model.fixed.count; ++j) {
    const double force = c.force[c.rows + j];
    s.port_force[j] = force;
    for (std::int32_t l = 0; l < model.lines; ++l) {
      const LineResponse by = response_of(model, j, l);
      const std::int32_t first = model.line[l].first;
      if (model.form == Form::banded) {
        panels_subtract(by.panels, force, by.second + first, w.solved + first);
        continue;
      }
      const Panels all{0, model.line[l].size / kLanes};
      panels_subtract(all, force, by.first + first, w.solved + first);
      panels_subtract(all, force, by.second + first, w.imaginary + first);
    }
  }
}

}  // namespace railstep
