#pragma once

#include <cstdint>

#include "online/model/caps.h"

namespace railstep {

/// A deformed rail of 3-node elements; a and b span the cross-section:
/// r(xi, y, z) = sum N_i(xi) (r_i + y a_i + z b_i), N = -xi(1-xi)/2, 1-xi^2, xi(1+xi)/2.
struct RailShape {
  int elements;         // >= 1
  const double* nodes;  // r (m), a, b (1) of each node: [2 elements + 1][9], element e has 2e to
                        // 2e + 2; or [elements][3][9], where they need not join
  int stride = 18;      // doubles from an element to the next: 18, or 27
};

/// A place on the rail's axis; xi in [-1, 1].
struct RailPlace {
  int element;
  double xi;
};

enum class LocateStatus : std::uint8_t {
  found,
  off_start,    // the solution lies before element 0; the place is the rail's start
  off_end,      // it lies after the last element; the place is the rail's end
  cap_reached,  // not settled (or not a number); the place is the last one tried
};

/// Distance beyond an end, in xi, that still counts as on the rail: rounding of 1 km.
inline constexpr double kEndSlack = 1e-12;

struct PointOnRail {
  LocateStatus status;
  int steps;        // evaluations of the rail
  RailPlace place;  // of the cross-section through the point
  double y, z;      // in that section, m
  double residual;  // |r(xi, y, z) - point|, m: 0 to rounding when found
};

/// Inverse map: the section plane (spanned by a and b) through a point, and its place in this
/// plane.
///
/// Newton's method on (point - r).(a x b) = 0, from which y and z follow linearly. It stays in the
/// bracket of signs found so far, and may cross element borders. On a border both sides give the
/// same point.
/// @param point  [3] m
/// @param start  the last step's place (clipped to the rail)
/// @param cap    most evaluations, clipped to 1..8
/// Cannot fail otherwise: the result is finite for every input, NaN included.
[[nodiscard]] PointOnRail locate_point(const RailShape& rail, const double* point, RailPlace start,
                                       int cap = kLocateSteps) noexcept;

struct WheelOnRail {
  LocateStatus status;
  int steps;
  RailPlace place;   // of the crown point nearest to the axle
  double distance;   // from the crown's centre curve to the axle line, m
  double normal[3];  // unit, from the curve to the axle, normal to it; 0 if they meet
  double along;      // e.(c - p): where along the axle, m
};

/// Closest approach of the axle line p + t e to the curve c(s) = r + z_crown b.
///
/// Newton's method on the derivative of |(I - e e')(c - p)|^2 / 2, which jumps at element borders:
/// a border to which both its sides point is the solution. A border bent towards the axle can have
/// a nearest point on each side, micrometres apart in distance; the first one found is returned.
/// @param p, e     [3] m; [3] unit
/// @param z_crown  height of the crown's centre of curvature above the axis, m
[[nodiscard]] WheelOnRail locate_wheel(const RailShape& rail, const double* p, const double* e,
                                       double z_crown, RailPlace start,
                                       int cap = kLocateSteps) noexcept;

}  // namespace railstep
