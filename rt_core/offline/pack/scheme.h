#pragma once
#include "online/model/model.h"

namespace railstep {

/// Generalised-alpha of Chung and Hulbert (1993) with equilibrium at the step's end (Arnold and
/// Bruls 2007): second order, high frequencies damped to rho_inf per step; rho_inf = 1 is the
/// trapezoidal rule. Throws std::invalid_argument outside dt > 0, 0 <= rho_inf <= 1.
Scheme generalised_alpha(double dt, double rho_inf);

/// Backward Euler: first order, L-stable.
Scheme backward_euler(double dt);

/// For condensed tracks: bodies move exactly under forces held over the step, and so do the lines.
/// Contact forces follow the penetration at theta = 1 / (1 + rho_inf): rho_inf = 1 gives up no
/// energy, 0 the most.
Scheme held_force(double dt, double rho_inf);

}  // namespace railstep
