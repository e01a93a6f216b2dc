#pragma once
#include "online/model/state.h"

namespace railstep {

/// Closing of a port by the lines, m, without its gap; of condensed lines by their modes.
/// @param re  [line_unknowns] displacements of banded lines, or real parts of modes
/// @param im  [line_unknowns] imaginary parts; not read for banded lines
double closing(const Model& model, std::int32_t port, const double* re, const double* im) noexcept;

/// The closing speed of a port in a state, m/s.
double closing_speed(const Model& model, std::int32_t port, const State& s) noexcept;

}  // namespace railstep
