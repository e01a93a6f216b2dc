#pragma once

namespace railstep {

/// Whether a mass that meets a Hertz contact C at a speed leaves it within 10 steps: it stays for
/// T = 2.9433 (5 m / 4 C)^0.4 v^-0.2 (Goldsmith, Impact, 1960).
/// @param inverse_mass  1/m, 1/kg; speed of closing, m/s
inline bool is_left_too_soon(double hertz, double inverse_mass, double speed, double dt) noexcept {
  const double depth = 1.25 / (inverse_mass * hertz), steps = 10. * dt / 2.9433;
  return speed > 0. && depth * depth < steps * steps * steps * steps * steps * speed;
}

}  // namespace railstep
