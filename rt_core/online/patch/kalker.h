#pragma once

namespace railstep {

/// Coefficients of linear creep: forces on the wheel of a patch with half lengths a along the rail
/// and b across are
///   Fx = -G ab c11 xi,  Fy = -G ab c22 eta - G (ab)^1.5 c23 phi,
/// and the moment about the normal is G (ab)^1.5 c23 eta - G (ab)^2 c33 phi.
struct Kalker {
  double c11, c22, c23, c33;
};

/// Kalker's coefficients by interpolation over a/b, good to 0.5 % of the tables between their rows.
/// Those for nu = 0.25 are Kalker's own (1967); those for nu = 0.3 are of the program CONTACT, two
/// grids extrapolated, and uncertain by 1 %. c33 is that of nu = 0.25 throughout.
/// @param ratio    a/b; the tables hold from 0.1 to 10; beyond, their end values hold
/// @param poisson  coefficients are linear between the tables from 0.25 to 0.3; beyond, those of
/// the nearer table hold
Kalker kalker(double ratio, double poisson) noexcept;

}  // namespace railstep
