#pragma once
#include <vector>

#include "offline/section/outline.h"

namespace railstep {

/// A polygon without the points that lie within `tolerance` (m) of a chord between kept points
/// (Ramer 1972).
std::vector<Point> simplified(std::span<const Point> polygon, double tolerance);

/// One side of a polygon about y = 0 and its mirror image, counter-clockwise, exactly symmetric,
/// simplified().
/// @param polygon  simple, counter-clockwise
/// @param side     +1 the side y > 0, -1 the other
/// Throws Refused where the polygon does not meet the axis exactly twice.
std::vector<Point> mirrored_side(std::span<const Point> polygon, int side, double tolerance);

}  // namespace railstep
