#pragma once
#include "online/model/model.h"

namespace railstep {

/// Elliptic Hertz contact of a wheel on a rail crown under a load.
struct HertzContact {
  double constant;       // C of P = C delta^1.5, N/m^1.5; the same for every load
  double approach;       // delta, m
  double half_along;     // semi-axis along the rail, m
  double half_across;    // semi-axis across, m
  double peak_pressure;  // p0, Pa
  double stiffness;      // dP/d(delta) = 1.5 P/delta, N/m
};

/// Complete elliptic integrals K and E of modulus squared m, by the arithmetic-geometric mean.
/// Abramowitz and Stegun 17.6; m in [0, 1).
struct EllipticIntegrals {
  double K, E;
};
EllipticIntegrals elliptic_integrals(double m);

/// Contact of two like elastic bodies: a wheel rolling along the rail (curved by wheel_radius
/// along the rail, straight across) on a crown (curved by crown_radius across, straight along).
///
/// With 1/(2 Rx) and 1/(2 Ry) the relative curvatures and k the ratio of the axes, m = 1 - k^2:
/// larger/smaller = (E/k^2 - K)/(K - E); Johnson, Contact Mechanics, 4.2.
/// @param wheel_radius, crown_radius  m, > 0
/// @param young, poisson              of both bodies: Pa, > 0; in (-1, 1/2]
/// @param load                        N, > 0
/// @throws Refused if a number is out of its range, or the radii differ so much
///   (beyond 1 : 1e6) that this is a line contact, which has no C of its own
HertzContact hertz_contact(double wheel_radius, double crown_radius, double young, double poisson,
                           double load);

/// C of P = C delta^1.5 of the same contact, N/m^1.5. It does not depend on the load.
double hertz_constant(double wheel_radius, double crown_radius, double young, double poisson);

/// Penetration of a contact under a force >= 0, m: by Hertz's law, or a spring's. The step has its
/// own root (online/contact/ports.cpp), which needs no C library.
double contact_depth(const ContactLaw& contact, double force);

}  // namespace railstep
