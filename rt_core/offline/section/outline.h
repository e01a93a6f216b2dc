#pragma once
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "offline/section/section.h"

namespace railstep {

using Point = std::array<double, 2>;  // y (lateral), z (up), m

/// Distance of two points, m.
inline double distance(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

/// One row of an outline: the end point of a segment that starts at the previous row's point.
struct OutlineRow {
  Point point;    // m
  double radius;  // m; 0 straight, > 0 arc turning left, < 0 arc turning right
  int number;     // row or line in its file, for messages
};

/// A straight line or a circular arc of less than half a turn.
struct Segment {
  Point from, to;  // m
  double radius;   // m, signed as in OutlineRow
  int number;      // of its end point's row
};

/// Centre, half angle and bisector of an arc.
struct Arc {
  Point centre;
  double radius;   // > 0
  double half;     // half of its angle
  Point outwards;  // unit, from the centre through the arc's middle
};

/// The arc of a segment that is not straight.
Arc arc_of(const Segment& segment);

/// A closed outline, counter-clockwise (steel on the left), lowest point at z = 0, and centred so
/// that the centroid lies at y = 0.
struct Outline {
  std::vector<Segment> segments;  // each starts where the one before it ends; the last closes
  double height;                  // m
};

/// Outline of half a symmetric profile mirrored about y = 0. Rows run from the middle of the foot
/// to the middle of the head, or the other way. The first row's radius means nothing. Throws
/// Refused for too few or repeated points, ends off the axis, points across it, NaN, a radius under
/// half the chord, crossing segments, an absurd height.
Outline mirrored_outline(std::span<const OutlineRow> half);

/// Outline through points in either direction; the first may be repeated at the end. Throws as
/// mirrored_outline(), and where the closing side is over three times the longest other: a gap.
Outline point_outline(std::span<const OutlineRow> points);

/// Area, centroid and second moments, exact by Green's theorem: the polygon of the end points plus
/// the circular segment over each arc's chord. With half angle t and centre c the segment has
///   A = R2 (t - s c), U = 2/3 R3 s3, UU = R4/4 (t - s c + 2 s3 c), VV = R4/12 (3t - 3 s c - 2 s3
///   c),
/// s = sin t, c = cos t, u along the bisector and v across it. Round-off grows as (R/height)^3.
AreaProperties<double> properties(const Outline& outline);

/// Iyz = int y z dA about the centroid, m4; 0 for a symmetric outline.
double product_of_inertia(const Outline& outline);

/// The outline as points, counter-clockwise, first not repeated, arcs cut into chords that leave
/// them by no more than `chord_tolerance` (m).
std::vector<Point> polygon(const Outline& outline, double chord_tolerance);

/// Area inside both a simple polygon and the rectangle [y0, y1] x [z0, z1], m2.
double area_inside(std::span<const Point> polygon, double y0, double y1, double z0, double z1);

/// Length of the part of the line {coordinate `axis` = at} between `from` and `to` of the other
/// coordinate that lies inside a simple polygon, m. axis 0: an upright line y = at; 1: level, z =
/// at.
double length_inside(std::span<const Point> polygon, int axis, double at, double from, double to);

/// y of the foot's middle, m: between the ends of a simple polygon at a hundredth of its height.
double foot_middle(std::span<const Point> polygon);

/// Area between a simple polygon and its mirror image about y = 0, over its own area; by 1000
/// levels of z, so good to 1e-3 of itself. 0 for a symmetric one.
double asymmetry(std::span<const Point> polygon);

}  // namespace railstep
