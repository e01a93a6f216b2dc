#include "offline/pack/time_schemes.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "offline/math/refuse.h"

namespace railstep {

namespace {

void check_step(double dt) {
  if (!(dt > 0.) || !std::isfinite(dt))
    refuse("E-PACK-46",
           "the time step is " + std::to_string(dt) + " s; expected a finite time above 0");
}

void check_rho(double rho_inf) {
  if (!(rho_inf >= 0.) || !(rho_inf <= 1.))
    refuse("E-PACK-47", "rho_inf is " + std::to_string(rho_inf) + "; expected 0 to 1");
}

/// M a_{1-alpha_m} + C v_{1-alpha_f} + K u_{1-alpha_f} = f_{1-alpha_f}, all means of a step's ends,
/// and Newmark's u1(a, a1), v1(a, a1). As g is in equilibrium at both ends, the mean of
/// f - C v - K u is that of M g for all forces:
///   a1 = [(1 - alpha_f) g1 + alpha_f g - alpha_m a] / (1 - alpha_m).
Scheme by_alphas(double dt, double alpha_m, double alpha_f, double beta, double gamma) {
  const double ag = (1. - alpha_f) / (1. - alpha_m), a0 = alpha_f / (1. - alpha_m);
  const double aa = -alpha_m / (1. - alpha_m);
  Scheme s{};
  s.dt = dt;
  s.uv = dt;
  s.ua = dt * dt * (.5 - beta + beta * aa);
  s.ug = dt * dt * beta * a0;
  s.va = dt * (1. - gamma + gamma * aa);
  s.vg = dt * gamma * a0;
  s.kg = 1. / (dt * dt * beta * ag);
  s.kv = gamma / (dt * beta);
  s.ag = ag;
  s.a0 = a0;
  s.aa = aa;
  s.theta = 1.;
  return s;
}

}  // namespace

Scheme generalised_alpha(double dt, double rho_inf) {
  check_step(dt);
  check_rho(rho_inf);
  const double alpha_m = (2. * rho_inf - 1.) / (rho_inf + 1.), alpha_f = rho_inf / (rho_inf + 1.);
  return by_alphas(dt, alpha_m, alpha_f, .25 * (1. - alpha_m + alpha_f) * (1. - alpha_m + alpha_f),
                   .5 - alpha_m + alpha_f);
}

Scheme newmark(double dt, double gamma, double beta) {
  check_step(dt);
  if (!(gamma >= .5) || !(gamma <= 1.) || !(beta >= .5 * gamma) || !(beta <= 1.))
    refuse("E-PACK-48", "newmark_gamma is " + std::to_string(gamma) + " and newmark_beta is " +
                            std::to_string(beta) +
                            "; expected a gamma from 1/2 to 1 and a beta from gamma/2 to 1, since "
                            "other values are not stable at every step");
  return by_alphas(dt, 0., 0., beta, gamma);
}

Scheme hilber_hughes_taylor(double dt, double alpha) {
  check_step(dt);
  if (!(alpha >= -1. / 3.) || !(alpha <= 0.))
    refuse("E-PACK-49", "hht_alpha is " + std::to_string(alpha) + "; expected -1/3 to 0");
  return by_alphas(dt, 0., -alpha, .25 * (1. - alpha) * (1. - alpha), .5 - alpha);
}

Scheme backward_euler(double dt) {
  check_step(dt);
  Scheme s{};
  s.dt = dt;
  s.uv = dt;
  s.kg = 1. / (dt * dt);
  s.kv = 1. / dt;
  s.ag = 1.;
  s.theta = 1.;
  return s;
}

Scheme tr_bdf2(double dt) {
  check_step(dt);
  const double part = 2. - std::sqrt(2.), tau = .5 * part * dt;
  // Up to part dt: v1 = v + tau (g + g1), u1 = u + tau (v + v1). Over the whole step, with
  // weight = 1 / (part (2 - part)) and (1 - part) / (2 - part) = part / 2 at this part:
  //   v1 = v0 + weight (vp - v0) + tau g1,  u1 = u0 + weight (up - u0) + tau v1.
  Scheme s{};
  s.dt = dt;
  s.uv = 2. * tau;
  s.ug = tau * tau;
  s.vg = tau;
  s.kg = 1. / (tau * tau);
  s.kv = 1. / tau;
  s.ag = 1.;
  s.theta = 1.;
  s.stage_fraction = part;
  s.stage_weight = 1. / (part * (2. - part));
  return s;
}

Scheme held_force(double dt, double rho_inf) {
  check_step(dt);
  check_rho(rho_inf);
  Scheme s{};
  s.dt = dt;
  s.uv = dt;
  s.kg = 2. / (dt * dt);
  s.kv = 2. / dt;
  s.ag = 1.;
  s.theta = 1. / (1. + rho_inf);
  return s;
}

Scheme held_mean_force(double dt) {
  Scheme s = held_force(dt, 0.);  // theta = 1
  s.mean = 1;
  return s;
}

double radius_at_infinity(const Scheme& s) {
  // An infinite stiffness gives u1 = 0, hence g1 = -kg u*, for all v, a and g.
  const Eigen::RowVector3d place(s.uv, s.ua, s.ug), speed(1., s.va, s.vg);  // u*, v* of [v, a, g]
  Eigen::Matrix3d step;
  step.row(0) = speed - s.kv * place;
  step.row(1) = -s.ag * s.kg * place + Eigen::RowVector3d(0., s.aa, s.a0);
  step.row(2) = -s.kg * place;
  // In units of the step: v, dt a, dt g.
  const Eigen::Vector3d unit(1., s.dt, s.dt);
  step = unit.asDiagonal() * step * unit.cwiseInverse().asDiagonal();
  return step.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace railstep
