#pragma once
#include "online/contact/coupling.h"

namespace railstep {

/// What the loads, and the forces of the step before at their new places, move the rail under a
/// wheel by the residual flexibility, m.
double residual_before(const Model& model, const State& s, const Coupling& c, ContactId i) noexcept;

/// Makes the laws of Hertz contacts means over the step, from the penetration that its start has in
/// the step's geometry. What is free of contact forces at its end must be known.
void find_means(const Model& model, const State& s, const Workspace& w, Coupling& c) noexcept;

}  // namespace railstep
