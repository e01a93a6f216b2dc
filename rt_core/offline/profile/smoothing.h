#pragma once
#include <span>

#include "offline/profile/running_surface.h"
#include "offline/section/outline.h"

namespace railstep {

/// A running surface through measured points, and how far it leaves them.
struct SmoothedSurface {
  RunningSurface surface;
  double rms, largest;  // m, of the distances from the points
};

/// The points are smoothed along the line that they make, and a natural cubic spline goes through
/// what they became. Smoothing takes the least integral of the squared second derivative, over the
/// length of the chords, among those lines whose distances from the points have a root mean square
/// of `tolerance`: C. H. Reinsch, Smoothing by spline functions, Numerische Mathematik 10, 1967. So
/// steep sides are smoothed as the crown is. 0 goes through all points; a tolerance above that of a
/// straight line gives that line.
/// @param points  (y, height), m, in the order of y
/// Throws Refused for fewer than 4 points, values that are not finite, places that do not rise once
/// smoothed, a gap (over 5 mm and over 5 times the middle spacing), a kink (a turn of over 0.35 rad
/// and over four times the mean of the turns beside it) and a point that lies over 6 tolerances
/// off.
SmoothedSurface smoothed(std::span<const Point> points, double tolerance);

}  // namespace railstep
