#pragma once
#include "online/model/model.h"

namespace railstep {

/// Generalised-alpha of Chung and Hulbert (1993) with equilibrium at the step's end (Arnold and
/// Bruls 2007): second order, high frequencies damped to rho_inf per step; rho_inf = 1 is the
/// trapezoidal rule. Throws Refused outside dt > 0, 0 <= rho_inf <= 1.
Scheme generalised_alpha(double dt, double rho_inf);

/// Newmark (1959) with equilibrium at the step's end; gamma = 1/2, beta = 1/4 is the trapezoidal
/// rule (average acceleration); every other gamma is of first order. Throws Refused if it is not
/// stable at every step; expected are 1/2 <= gamma <= 1 and gamma/2 <= beta <= 1.
Scheme newmark(double dt, double gamma = .5, double beta = .25);

/// Hilber, Hughes and Taylor (1977), with the mean of the forces too (Hughes 2000, section 9.3):
///   M a1 + (1 + alpha) (C v1 + K u1 - f1) - alpha (C v + K u - f) = 0,
/// gamma = 1/2 - alpha, beta = (1 - alpha)^2/4: generalised-alpha's alpha_m = 0, alpha_f = -alpha.
/// Second order. Throws Refused outside -1/3 <= alpha <= 0.
Scheme hilber_hughes_taylor(double dt, double alpha);

/// Backward Euler: first order, L-stable.
Scheme backward_euler(double dt);

/// TR-BDF2 (Bank, Coughran, Fichtner, Grosse, Rose, Smith 1985) with gamma = 2 - sqrt 2: then the
/// trapezoidal rule up to gamma dt and the backward difference over the whole step have the same
/// matrix. Two solves a step; second order, L-stable.
Scheme tr_bdf2(double dt);

/// For condensed tracks: bodies and lines move exactly under forces that are held over the step.
/// Contact forces follow the penetration at theta = 1 / (1 + rho_inf): rho_inf = 1 dissipates no
/// energy, 0 the most.
Scheme held_force(double dt, double rho_inf);

/// The same, but the force of a Hertz contact is the mean of its law over the change of
/// penetration, [V(d1) - V(d0)] / (d1 - d0) (Gonzalez 1996). Its work then equals the energy that
/// the contact stores, and no impact makes energy. Other contacts follow the penetration at the
/// step's end, which makes no energy either.
Scheme held_mean_force(double dt);

/// Spectral radius of a step with infinite stiffness, or with a joint: rho_inf of
/// generalised-alpha, (1 + alpha)/(1 - alpha) of Hilber, Hughes and Taylor, 1 of the trapezoidal
/// rule. Accurate to 1e-5, as roots may be triple. For schemes of one stage.
double radius_at_infinity(const Scheme& scheme);

}  // namespace railstep
