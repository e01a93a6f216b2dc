#pragma once
#include "online/model/model.h"

namespace railstep {

/// Generalised-alpha of Chung and Hulbert (1993) with equilibrium at the step's end (Arnold and
/// Bruls 2007): second order, high frequencies damped to rho_inf per step; rho_inf = 1 is the
/// trapezoidal rule. Throws std::invalid_argument outside dt > 0, 0 <= rho_inf <= 1.
Scheme generalised_alpha(double dt, double rho_inf);

/// Newmark (1959) with equilibrium at the step's end; gamma = 1/2, beta = 1/4 is the trapezoidal
/// rule (average acceleration), every other gamma of first order. Throws std::invalid_argument
/// where it is not stable at every step: accepted are 1/2 <= gamma <= 1 and gamma/2 <= beta <= 1.
Scheme newmark(double dt, double gamma = .5, double beta = .25);

/// Hilber, Hughes and Taylor (1977), forces taken as their mean too (Hughes 2000, section 9.3):
///   M a1 + (1 + alpha) (C v1 + K u1 - f1) - alpha (C v + K u - f) = 0,
/// gamma = 1/2 - alpha, beta = (1 - alpha)^2/4: generalised-alpha's alpha_m = 0, alpha_f = -alpha.
/// Second order. Throws std::invalid_argument outside -1/3 <= alpha <= 0.
Scheme hilber_hughes_taylor(double dt, double alpha);

/// Backward Euler: first order, L-stable.
Scheme backward_euler(double dt);

/// TR-BDF2 (Bank, Coughran, Fichtner, Grosse, Rose, Smith 1985) with gamma = 2 - sqrt 2, at which
/// the trapezoidal rule up to gamma dt and the backward difference over the whole step have the
/// same matrix: two solves a step. Second order, L-stable.
Scheme tr_bdf2(double dt);

/// For condensed tracks: bodies move exactly under forces held over the step, and so do the lines.
/// Contact forces follow the penetration at theta = 1 / (1 + rho_inf): rho_inf = 1 gives up no
/// energy, 0 the most.
Scheme held_force(double dt, double rho_inf);

/// The same, with the force of a Hertz contact the mean of its law over the way that the
/// penetration goes, [V(d1) - V(d0)] / (d1 - d0) (Gonzalez 1996), so that its work is what the
/// contact stores and no impact makes energy. Other contacts follow the penetration at the step's
/// end, which makes none.
Scheme held_mean_force(double dt);

/// Spectral radius of a step where the stiffness is without bound, or a joint holds: rho_inf of
/// generalised-alpha, (1 + alpha)/(1 - alpha) of Hilber, Hughes and Taylor, 1 of the trapezoidal
/// rule. Roots may be triple: good to 1e-5. Of schemes of one stage.
double radius_at_infinity(const Scheme& scheme);

}  // namespace railstep
