#pragma once
#include "online/contact/coupling.h"

namespace railstep {

/// Residual displacement of the rail under a wheel by the loads and by the forces of the step
/// before at their new places, m. For a row of a seat the forces on that seat are left out.
double residual_before(const Model& model, const State& s, const Coupling& c, int i) noexcept;

/// Makes the laws of Hertz contacts means over the step, from the penetration at its start in the
/// step's geometry. Positions without contact forces at its end must be known.
void find_means(const Model& model, const State& s, Coupling& c) noexcept;

}  // namespace railstep
