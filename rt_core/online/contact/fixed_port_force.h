#pragma once
#include "online/contact/coupling.h"

namespace railstep {

// Ports at fixed places in a step's coupled problem: supports that do not pull, gaps, stops. Their
// rows are fixed, so that the model contains the response of the lines to a unit force along each.

/// Appends the fixed ports to the wheels: laws, penetrations without port forces, their part of W,
/// and the last step's forces. Banded lines without port forces are halfway solved in
/// workspace.solved (track_response.h); modes are there at the step's end.
void couple_fixed_ports(const Model& model, const State& s, const Workspace& w,
                        Coupling& c) noexcept;

/// Moves the lines by the fixed ports' forces, and stores these in the state.
void apply_fixed_port_forces(const Model& model, const Coupling& c, State& s,
                             Workspace& w) noexcept;

}  // namespace railstep
