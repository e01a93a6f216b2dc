#pragma once
#include "online/model/state.h"

namespace railstep {

/// Numbers in a row of a trace.
std::int32_t trace_columns(const Model& model) noexcept;

/// A row of a trace: time_s, then of every load x_m and deflection_z_m; of every wheel force_z_n,
/// its mean, peak and impulse over the frame, gap_m and rail_z_m; of flanges force, peak, impulse
/// and gap; of external wheels displacement and velocity of the rail; track sensors; of a system's
/// sensors position, displacement and vz_m_per_s; of traced joints force and moment; of traced
/// springs their pull. Left as it is of a state that is latched as not finite.
/// @param outputs  that the state's frame published
/// @param row      [trace_columns()]
void trace_row(const Model& model, const State& state, const Outputs& outputs,
               double* row) noexcept;

}  // namespace railstep
