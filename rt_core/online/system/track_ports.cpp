#include "online/system/track_ports.h"

#include "online/system/rows.h"

namespace railstep {

void read_ports(const Model& model, const Configuration& at, double* out) noexcept {
  const SystemModel& s = model.system;
  for (std::int32_t p = 0; p < s.ports; ++p) {
    const RailPortModel& port = s.port[p];
    for (int k = 0; k < 9; ++k) {
      double sum = 0.;
      for (std::int32_t l = 0; l < model.lines; ++l)
        for (int i = 0; i < 3; ++i)
          sum += port.value[i] * weight_of(model.line[l], port.rail, k) *
                 nodal_value(model.line[l], port.rail, {port.element, i}, k, at);
      out[9 * p + k] = sum;
    }
    const Cant& cant = model.cant[port.rail];
    if (cant.sine == 0.) continue;
    for (int i = 0; i < 9; i += 3) {
      const double own[3] = {out[9 * p + i], out[9 * p + i + 1], out[9 * p + i + 2]};
      to_track(cant, own, out + (9 * p + i));
    }
  }
}

void subtract_line_motion(const Model& model, const double* gradient, const double* force,
                          double* re, double* im) noexcept {
  const SystemModel& s = model.system;
  const std::int32_t track = s.bodies + s.beams;
  for (std::int32_t e = s.part_end[track]; e < s.part_end[track + 1]; ++e) {
    const std::int32_t port = port_of_end(s, e);
    for (int k = 0; k < 9; ++k) {
      const double f = force[s.end[e].row] * gradient[std::ptrdiff_t{kMostNodeUnknowns} * e + k];
      const PortShape shape = port_shape(model, 9 * port + k);
#pragma omp simd
      for (std::int32_t i = 0; i < model.line_unknowns; ++i) re[i] -= f * shape.re[i];
      if (model.form == Form::banded) continue;
#pragma omp simd
      for (std::int32_t i = 0; i < model.line_unknowns; ++i) im[i] -= f * shape.im[i];
    }
  }
}

namespace {

/// The part of row forces on the ports. @param out  [9 ports]
void gather_ports(const SystemModel& s, const SystemWorkspace& w, const double* row_force,
                  double* out) noexcept {
  for (std::int32_t i = 0; i < 9 * s.ports; ++i) out[i] = 0.;
  const std::int32_t track = s.bodies + s.beams;
  for (std::int32_t e = s.part_end[track]; e < s.part_end[track + 1]; ++e) {
    const double* g = w.gradient + std::ptrdiff_t{kMostNodeUnknowns} * e;
    double* const port = out + std::ptrdiff_t{9} * port_of_end(s, e);
    for (int k = 0; k < 9; ++k) port[k] += row_force[s.end[e].row] * g[k];
  }
}

}  // namespace

void find_port_forces(const Model& model, const State& state, const Workspace& workspace,
                      double* force) noexcept {
  const SystemWorkspace w = system_workspace_on(model.system, workspace.system, state.kept);
  gather_ports(model.system, w, w.force, force);
}

void find_port_change(const Model& model, const State& state, const Workspace& workspace,
                      const double* moved, double* change) noexcept {
  const SystemModel& s = model.system;
  SystemWorkspace w = system_workspace_on(s, workspace.system, state.kept);
  for (std::int32_t r = 0; r < system_rows(s); ++r) w.wanted[r] = 0.;
  const std::int32_t track = s.bodies + s.beams;
  for (std::int32_t e = s.part_end[track]; e < s.part_end[track + 1]; ++e) {
    const double* slope = w.slope + std::ptrdiff_t{kMostNodeUnknowns} * e;
    const double* port = moved + std::ptrdiff_t{9} * port_of_end(s, e);
    for (int k = 0; k < 9; ++k) w.wanted[s.end[e].row] += slope[k] * port[k];
  }
  solve_rows(model, w, true, w.wanted);
  gather_ports(s, w, w.wanted, change);
}

}  // namespace railstep
