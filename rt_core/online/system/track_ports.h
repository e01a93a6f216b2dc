#pragma once
#include "online/model/model.h"
#include "online/system/parts.h"

namespace railstep {

/// Displacements r, a, b of the track's lines at every port, [9 ports]. @param u  of all lines
void read_ports(const Model& model, const double* u, double* out) noexcept;

/// rates -= S^-1 B' G' force: response of the lines to row forces. @param rates  [lines' unknowns]
void subtract_line_motion(const Model& model, const double* gradient, const double* force,
                          double* rates) noexcept;

}  // namespace railstep
