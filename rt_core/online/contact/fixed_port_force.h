#pragma once
#include "online/contact/coupling.h"

namespace railstep {

// Ports that stand still in a step's coupled problem: supports that do not pull, gaps, stops. Their
// rows are fixed, so what a unit force along each does to the lines comes with the model.

/// Puts the fixed ports behind the wheels: laws, penetrations without port forces, their part of W,
/// and the last step's forces. The track without port forces is in workspace.solved.
void couple_fixed_ports(const Model& model, const State& s, const Workspace& w,
                        Coupling& c) noexcept;

/// Moves the lines by the fixed ports' forces, which pass into the state.
void apply_fixed_port_forces(const Model& model, const Coupling& c, State& s,
                             Workspace& w) noexcept;

}  // namespace railstep
