#include "online/system/track_ports.h"

#include "online/system/marker.h"
#include "online/track/line.h"

namespace railstep {

void read_ports(const Model& model, const double* u, double* out) noexcept {
  const SystemModel& s = model.system;
  const Configuration at{u, {nullptr, nullptr}};
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
  }
}

void subtract_line_motion(const Model& model, const double* gradient, const double* force,
                          double* rates) noexcept {
  const SystemModel& s = model.system;
  const std::int32_t track = s.bodies + s.beams;
  for (std::int32_t e = s.part_end[track]; e < s.part_end[track + 1]; ++e) {
    const EndModel& end = s.end[e];
    const RowModel& row = s.row[end.row];
    const std::int32_t port = s.marker[end.side == 0 ? row.a : row.b].part;
    for (int k = 0; k < 9; ++k) {
      const double f = force[end.row] * gradient[std::ptrdiff_t{kMostNodeUnknowns} * e + k];
      const double* shape = s.port_shapes + std::ptrdiff_t{model.line_unknowns} * (9 * port + k);
#pragma omp simd
      for (std::int32_t i = 0; i < model.line_unknowns; ++i) rates[i] -= f * shape[i];
    }
  }
}

}  // namespace railstep
