#pragma once

namespace railstep {

/// Part of the approach by which bodies overlap in Kik and Piotrowski's law.
inline constexpr double kVirtualPart = .55;
/// The law's modulus over that of the bodies. It is calibrated: with it the mean approach on 24
/// patches of 10 kN is that of the half-space (docs/wheel-rail.md has others to compare with).
inline constexpr double kOfModulus = .979;
/// Minima of the gap of less depth share patches as if they had this depth, m.
inline constexpr double kLeastPatchDepth = 3e-5;

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

/// Where the approach fixes the pressure of a patch: two points, in strips from the middle of the
/// first one, and the mean gap, m.
struct Collocation {
  double first, second, gap;
};

/// Two bodies that touch along strips.
struct StripPatch {
  const double* gap;  // [strips], along the normal where the bodies just touch, m: at least 0
  int strips;         // at most kMostPatchStrips
  double deepest;     // the point of least gap, in strips from the middle of the first one
  Collocation collocation;
  double width;    // of a strip, m
  double radius;   // of the wheel in the plane along the rail, m
  double modulus;  // E / (1 - nu^2) of two like bodies, N/m2
};

/// The normal force by virtual penetration with semi-elliptic strips: J. Piotrowski and W. Kik, A
/// simplified model of wheel/rail contact mechanics for non-Hertzian problems, Vehicle System
/// Dynamics 46, 2008. Bodies overlap by 0.55 of the approach d. A strip where they overlap has the
/// half length l,
///   l^2 = 2 R (0.55 d - gap).
/// Its pressure is p sqrt(l^2 - x^2) with one p for all strips. The approach fixes p, by
/// Boussinesq:
///   N = k pi E (d - gap) / (2 (1 - nu^2)) I1 / I2,   I1 = sum of pi l^2 / 2,
///   I2 = sum of 2 sqrt(l^2 + y^2) (K - E)(k),   k^2 = l^2 / (l^2 + y^2),
/// K and E the complete elliptic integrals. Kik and Piotrowski take the approach at the point of
/// least gap. That point leaps between two valleys of one patch, and the force with it. Here the
/// approach is the mean over the patch with weights l^3. The mean of I2 is by Gauss' rule of two
/// points, one standard deviation to both sides of the mean place, see collocation_of(). Near a
/// point the terms of I2 grow as -log y. Hence y^2 of a strip is taken so that its logarithm is the
/// mean of log y^2 over the strip. From a strip's width on this is less than y^2 at the strip's
/// middle by width^2 / 12. The work of the force is a function of the approach.
/// @param approach  m; 0 or less gives no force
PatchForce patch_force(const StripPatch& patch, double approach) noexcept;

/// Finds Collocation of a patch; StripPatch::collocation is not read.
Collocation collocation_of(const StripPatch& patch, double approach) noexcept;

/// Shift of the centre of pressure across by a tilt of one body about x, m: the inverse of the
/// difference of their curvatures, where these do not change over the patch. 0 where nothing
/// overlaps.
double shift_by_tilt(const StripPatch& patch, double approach) noexcept;

/// How far two neighbouring minima of the gap are separate patches. It is 0 where the ridge between
/// them is well within the deeper one's overlap, or not above the higher minimum; away from that it
/// rises to 1.
/// @param deeper, higher, ridge  gaps, m, negative where the bodies overlap
/// @param least_depth            m, above 0: a deeper minimum of less depth counts as if it had
/// this depth
inline double patches_apart(double deeper, double higher, double ridge,
                            double least_depth) noexcept {
  constexpr double kPassage = .25;  // of an overlap, to both sides, and of a depth
  constexpr double kLeast = 1e-6;   // m: the force of a patch of less depth does not matter
  const auto smooth = [](double part) noexcept -> double {
    return !(part > 0.) ? 0. : part < 1. ? part * part * (3. - 2. * part) : 1.;
  };
  const auto depth = [](double gap, double least) noexcept -> double {
    return -gap > least ? -gap : least;
  };
  const double overlap = kVirtualPart * depth(deeper, least_depth);
  return smooth((ridge - deeper - (1. - kPassage) * overlap) / (2. * kPassage * overlap)) *
         smooth((ridge - higher) / (kPassage * depth(higher, kLeast)));
}

/// Calls `of(first, last, share)` for each run of neighbouring minima that has a share above 0 as
/// one patch. The shares of the runs that hold a minimum have a sum of 1.
/// @param apart  apart(i): patches_apart() of minima i - 1 and i; not called with 0
template <class Apart, class Of>
void for_each_share(int count, const Apart& apart, const Of& of) {
  for (int first = 0; first < count; ++first) {
    double share = first > 0 ? apart(first) : 1.;
    for (int last = first; last < count && share > 0.; ++last) {
      const double beyond = last + 1 < count ? apart(last + 1) : 1.;
      if (share * beyond > 0.) of(first, last, share * beyond);
      share *= 1. - beyond;
    }
  }
}

}  // namespace railstep
