#pragma once

#include <array>
#include <vector>

namespace railstep {

/// A section's right half, y >= 0: counter-clockwise (y, z), m. The first point is the foot's and
/// the last the top's point on the axis (y exactly 0); the axis itself closes the polygon.
using HalfPolygon = std::vector<std::array<double, 2>>;

/// Checks the outline of a symmetric section and cuts it along its axis y = 0.
/// @param polygon  counter-clockwise (y, z), m; mirrored points agree to 1e-6 of its width plus
///                 height
/// @throws Refused: fewer than three points, a number that is not
///         finite, coinciding neighbours, clockwise, crossing itself, not symmetric, or not
///         meeting its axis exactly twice
HalfPolygon right_half(const std::vector<std::array<double, 2>>& polygon);

/// Throws as right_half(), except for symmetry and axis.
void check_polygon(const std::vector<std::array<double, 2>>& polygon);

/// True when `point` is inside the closed polygon; either answer on its boundary.
bool is_inside(const std::vector<std::array<double, 2>>& polygon,
               const std::array<double, 2>& point);

}  // namespace railstep
