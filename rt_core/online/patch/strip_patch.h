#pragma once

namespace railstep {

/// Part of the approach by which bodies overlap in Kik and Piotrowski's law.
inline constexpr double kVirtualPart = .55;
/// The law's modulus over that of the bodies. It is calibrated: with it the mean approach on 24
/// patches of 10 kN is that of the half-space (docs/wheel-rail.md has others to compare with).
inline constexpr double kOfModulus = .979;

/// A contact patch under an approach: its force and its shape.
struct PatchForce {
  double normal;       // N
  double stiffness;    // of the normal force over the approach, N/m
  double pressure;     // largest, N/m2
  double centre;       // of the pressure, across, m from the point of least gap
  double half_length;  // along the rail, m
  double half_width;   // of the ellipse of the same length and area, m
};

inline constexpr int kMostPatchStrips = 129;

/// Where a patch holds its approach: at two points, in strips from the middle of the first one, and
/// a mean gap, m.
struct PatchHold {
  double first, second, gap;
};

/// Two bodies that touch along strips.
struct StripPatch {
  const double* gap;  // [strips], along the normal where the bodies just touch, m: at least 0
  int strips;         // at most kMostPatchStrips
  double deepest;     // the point of least gap, in strips from the middle of the first one
  PatchHold hold;
  double width;    // of a strip, m
  double radius;   // of the wheel in the plane along the rail, m
  double modulus;  // E / (1 - nu^2) of two like bodies, N/m2
};

/// The normal force by virtual penetration with semi-elliptic strips: J. Piotrowski and W. Kik, A
/// simplified model of wheel/rail contact mechanics for non-Hertzian problems, Vehicle System
/// Dynamics 46, 2008. Bodies overlap by 0.55 of the approach d, a strip where they do is long
///   l^2 = 2 R (0.55 d - gap)
/// to each side, its pressure is p sqrt(l^2 - x^2) with one p for all strips, and p holds the
/// approach, by Boussinesq:
///   N = k pi E (d - gap) / (2 (1 - nu^2)) I1 / I2,   I1 = sum of pi l^2 / 2,
///   I2 = sum of 2 sqrt(l^2 + y^2) (K - E)(k),   k^2 = l^2 / (l^2 + y^2),
/// K and E the complete elliptic integrals. Kik and Piotrowski hold it at the point of least gap.
/// That leaps between two valleys of one patch, and the force with it. Here it holds in the mean
/// over the patch with weights l^3: of I2 by Gauss' rule of two points, one standard deviation to
/// both sides of the mean place, see hold_of(). Near a point the terms of I2 grow as -log y: y^2 is
/// that whose logarithm is the mean over a strip, which from a strip's width on is less by width^2
/// / 12. The work of the force is a function of the approach.
/// @param approach  m; 0 or less gives no force
PatchForce patch_force(const StripPatch& patch, double approach) noexcept;

/// Where a patch holds its approach, of a patch whose hold is not known yet.
PatchHold hold_of(const StripPatch& patch, double approach) noexcept;

}  // namespace railstep
