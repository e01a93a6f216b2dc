#pragma once
#include "online/model/state.h"
#include "online/track/line.h"

namespace railstep {

/// The port of a row's end on the track.
inline std::int32_t port_of_end(const SystemModel& system, std::int32_t end) noexcept {
  const RowModel& row = system.row[system.end[end].row];
  return system.marker[system.end[end].side == 0 ? row.a : row.b].part;
}

/// Displacements r, a, b of the track's lines at every port, [9 ports].
void read_ports(const Model& model, const Configuration& at, double* out) noexcept;

/// Motion of all lines by a unit force along one of the ports' coordinates; of banded lines `im` is
/// not used.
struct PortShape {
  const double *re, *im;  // [lines' unknowns]
};
inline PortShape port_shape(const Model& model, std::int32_t k) noexcept {
  const double* re =
      model.system.port_shapes + std::ptrdiff_t{parts(model.form)} * model.line_unknowns * k;
  return {re, re + (parts(model.form) - 1) * std::ptrdiff_t{model.line_unknowns}};
}

/// lines -= S^-1 B' G' force: response of the lines to row forces.
/// @param re, im  [lines' unknowns]; of banded lines `im` is not used
void subtract_line_motion(const Model& model, const double* gradient, const double* force,
                          double* re, double* im) noexcept;

/// Forces of the rows on the ports, by the present iterate: the lines move by minus these.
/// @param force  [9 ports] out
void find_port_forces(const Model& model, const State& state, const Workspace& workspace,
                      double* force) noexcept;

/// Change of these forces by a change of the ports' free motion, by the present matrix.
/// @param moved  [9 ports] @param change  [9 ports] out
void find_port_change(const Model& model, const State& state, const Workspace& workspace,
                      const double* moved, double* change) noexcept;

}  // namespace railstep
