#pragma once
#include "online/contact/coupling.h"

namespace railstep {

// Ports that stand still in a step's coupled problem: supports that do not pull, gaps, stops. Their
// rows are fixed, so what a unit force along each does to the lines comes with the model.

/// Puts the fixed ports behind the wheels: laws, penetrations without port forces, their part of W,
/// and the last step's forces. The track without port forces is in workspace.solved.
///
/// Over a step a spring k and damper c are slope d + jump (PortLaw) in what the force follows:
/// - of banded lines the depth d at the step's end, where the scheme has v1 = v* + kv (u1 - u*).
///   With row u1 = d + gap the velocity is kv d + v0, v0 = row (v* - kv u*) + kv gap;
/// - of condensed lines, whose forces are held over the step, D = theta d1 + (1 - theta) d0, and
///   the mean velocity (d1 - d0)/dt = (D - d0)/(theta dt): kv = 1/(theta dt), v0 = -kv d0. So the
///   damper takes c (d1 - d0)^2/dt, and the spring no less than it keeps for theta >= 1/2, while
///   the port stays closed.
void couple_fixed_ports(const Model& model, const State& s, const Workspace& w,
                        Coupling& c) noexcept;

/// Moves the lines by the fixed ports' forces, which pass into the state.
void press_fixed_ports(const Model& model, const Coupling& c, State& s, Workspace& w) noexcept;

}  // namespace railstep
