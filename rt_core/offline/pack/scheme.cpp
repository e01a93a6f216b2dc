#include "offline/pack/scheme.h"

#include <cmath>
#include <stdexcept>

namespace railstep {

namespace {

void check_step(double dt) {
  if (!(dt > 0.) || !std::isfinite(dt))
    throw std::invalid_argument("the step is a finite time above zero");
}

void check_rho(double rho_inf) {
  if (!(rho_inf >= 0.) || !(rho_inf <= 1.))
    throw std::invalid_argument("rho_inf lies between 0 and 1");
}

}  // namespace

Scheme generalised_alpha(double dt, double rho_inf) {
  check_step(dt);
  check_rho(rho_inf);
  const double alpha_m = (2. * rho_inf - 1.) / (rho_inf + 1.), alpha_f = rho_inf / (rho_inf + 1.);
  const double gamma = .5 - alpha_m + alpha_f;
  const double beta = .25 * (1. - alpha_m + alpha_f) * (1. - alpha_m + alpha_f);
  // a1 = [(1 - alpha_f) g1 + alpha_f g - alpha_m a] / (1 - alpha_m), put into Newmark's formulas
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

}  // namespace railstep
