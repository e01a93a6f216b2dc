#pragma once
#include <span>
#include <vector>

#include "offline/profile/running_surface.h"
#include "offline/section/outline.h"

namespace railstep {

/// Measured points without their noise, and how far they moved.
struct SmoothedPoints {
  std::vector<Point> points;
  double rms, largest;  // m, of the distances from the points
};

/// Smooths points along the line that they make. Among the lines whose distances from the points,
/// those along the line included, have a root mean square of `tolerance`, it takes the one with the
/// least integral of the squared second derivative over the length of the chords: C. H. Reinsch,
/// Smoothing by spline functions, Numerische Mathematik 10, 1967. So steep sides are smoothed as
/// the crown is. 0 leaves the points; a tolerance above that of a straight line gives that line.
/// @param points  (y, height), m, one beside the other
/// Throws Refused for fewer than 4 points, values that are not finite, a point that is given twice,
/// a gap (over 5 mm and over 5 times the middle spacing), a kink (a turn of over 0.35 rad and over
/// four times the mean of the turns beside it) and a point that lies over 8 tolerances off.
SmoothedPoints smoothed(std::span<const Point> points, double tolerance);

/// The natural cubic spline through points. Throws Refused for fewer than 4 points, where their
/// places do not rise, and where the spline turns by over 0.5 rad away from the chord of two
/// points.
RunningSurface through(std::span<const Point> points);

}  // namespace railstep
