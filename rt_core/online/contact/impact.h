#pragma once

namespace railstep {

/// Whether a mass that meets a Hertz contact C at a speed leaves it within 10 steps. The contact
/// lasts T = 2.9433 (5 m / 4 C)^0.4 v^-0.2 (Goldsmith, Impact, 1960).
/// @param inverse_mass  1/m, 1/kg; speed of closing, m/s
inline bool impact_is_unresolved(double hertz, double inverse_mass, double speed,
                                 double dt) noexcept {
  const double depth = 1.25 / (inverse_mass * hertz), steps = 10. * dt / 2.9433;
  return speed > 0. && depth * depth < steps * steps * steps * steps * steps * speed;
}

/// The same for a spring, with half a period: pi sqrt(m / k). A damper beside it shortens this by
/// up to a third if it is critical.
inline bool spring_impact_is_unresolved(double stiffness, double inverse_mass, double speed,
                                        double dt) noexcept {
  const double steps = 10. * dt / 3.14159265358979;
  return speed > 0. && 1. < steps * steps * stiffness * inverse_mass;
}

}  // namespace railstep
