#include "offline/section/outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "offline/math/refuse.h"
#include "offline/section/outline_checks.h"

namespace railstep {

Arc arc_of(const Segment& s) {
  const double dy = s.to[0] - s.from[0], dz = s.to[1] - s.from[1];
  const double chord = std::hypot(dy, dz);
  const double r = std::abs(s.radius);
  const double sine = std::min(1.0, 0.5 * chord / r);
  const double depth = r * std::sqrt(1.0 - sine * sine);  // from the centre to the chord
  // The right-hand normal of travel points out of an arc that turns left, into one that turns
  // right.
  const double sign = s.radius > 0.0 ? 1.0 : -1.0;
  const Point out = {sign * dz / chord, -sign * dy / chord};
  return {
      {0.5 * (s.from[0] + s.to[0]) - depth * out[0], 0.5 * (s.from[1] + s.to[1]) - depth * out[1]},
      r,
      std::asin(sine),
      out};
}

namespace {

constexpr double kRounding = 1e-8;  // m

/// Moments about the origin: area, first and second moments.
struct Moments {
  double area = 0.0, y = 0.0, z = 0.0, yy = 0.0, zz = 0.0, yz = 0.0;
};

void add_line(const Segment& s, Moments& m) {
  const auto [y0, z0] = s.from;
  const auto [y1, z1] = s.to;
  const double cross = y0 * z1 - y1 * z0;
  m.area += cross / 2.0;
  m.y += cross * (y0 + y1) / 6.0;
  m.z += cross * (z0 + z1) / 6.0;
  m.yy += cross * (y0 * y0 + y0 * y1 + y1 * y1) / 12.0;
  m.zz += cross * (z0 * z0 + z0 * z1 + z1 * z1) / 12.0;
  m.yz += cross * (2.0 * (y0 * z0 + y1 * z1) + y0 * z1 + y1 * z0) / 24.0;
}

void add_circular_segment(const Segment& s, Moments& m) {
  const auto [c, r, t, e] = arc_of(s);
  const double sn = std::sin(t), cs = std::cos(t), thin = t - sn * cs, s3c = sn * sn * sn * cs;
  const double sign = s.radius > 0.0 ? 1.0 : -1.0;  // a fillet takes away
  const double area = sign * r * r * thin;
  const double u = sign * 2.0 / 3.0 * r * r * r * sn * sn * sn;
  const double uu = sign * r * r * r * r / 4.0 * (thin + 2.0 * s3c);
  const double vv = sign * r * r * r * r / 12.0 * (3.0 * thin - 2.0 * s3c);
  m.area += area;
  m.y += c[0] * area + e[0] * u;
  m.z += c[1] * area + e[1] * u;
  m.yy += c[0] * c[0] * area + 2.0 * c[0] * e[0] * u + e[0] * e[0] * uu + e[1] * e[1] * vv;
  m.zz += c[1] * c[1] * area + 2.0 * c[1] * e[1] * u + e[1] * e[1] * uu + e[0] * e[0] * vv;
  m.yz += c[0] * c[1] * area + (c[0] * e[1] + c[1] * e[0]) * u + e[0] * e[1] * (uu - vv);
}

Moments moments_of(const std::vector<Segment>& segments) {
  Moments m;
  for (const Segment& s : segments) {
    add_line(s, m);
    if (s.radius != 0.0) add_circular_segment(s, m);
  }
  return m;
}

/// Least and largest coordinate, arcs included. @param axis  0 y, 1 z
std::array<double, 2> extent(const std::vector<Segment>& segments, std::size_t axis) {
  double low = segments.front().from[axis], high = low;
  for (const Segment& s : segments) {
    low = std::min(low, s.to[axis]);
    high = std::max(high, s.to[axis]);
    if (s.radius == 0.0) continue;
    const Arc a = arc_of(s);
    // The arc holds its circle's lowest or highest point if that lies within its half angle. A
    // crown whose centre is off the axis by the rounding of the drawing rises 0.2 nm above its
    // middle, which is neglected.
    const double bottom = a.centre[axis] - a.radius, top = a.centre[axis] + a.radius;
    if (-a.outwards[axis] > std::cos(a.half) && bottom < low - kRounding) low = bottom;
    if (a.outwards[axis] > std::cos(a.half) && top > high + kRounding) high = top;
  }
  return {low, high};
}

void reverse(std::vector<Segment>& segments) {
  std::reverse(segments.begin(), segments.end());
  for (Segment& s : segments) {
    std::swap(s.from, s.to);
    s.radius = -s.radius;
  }
}

/// Checks, turns counter-clockwise, and moves the lowest point to z = 0 and the centroid to y = 0.
Outline finish(std::vector<Segment> segments) {
  for (const Segment& s : segments) check_segment(s);
  const auto [left, right] = extent(segments, 0);
  const auto [low, high] = extent(segments, 1);
  check_size(right - left, high - low);
  check_crossing(segments);
  if (moments_of(segments).area < 0.0) reverse(segments);
  const Moments m = moments_of(segments);
  if (!(m.area > 1e-6 * (high - low) * (high - low)))
    refuse("E-SECTION-09", "the outline encloses no area; list its points in order around it");
  const double across = m.y / m.area;
  // A mirrored outline is exact about y = 0 already: moving it by round-off would spoil that.
  const double shift = std::abs(across) > 1e-12 * (high - low) ? across : 0.0;
  for (Segment& s : segments) {
    s.from = {s.from[0] - shift, s.from[1] - low};
    s.to = {s.to[0] - shift, s.to[1] - low};
  }
  return {std::move(segments), high - low};
}

void append_arc(const Segment& s, double chord_tolerance, std::vector<Point>& points) {
  const Arc a = arc_of(s);
  // A chord over the angle 2b leaves the arc by R (1 - cos b).
  const double step = 2.0 * std::acos(std::max(0.0, 1.0 - chord_tolerance / a.radius));
  const int n = std::max(1, static_cast<int>(std::ceil(2.0 * a.half / std::max(step, 1e-6))));
  const double middle = std::atan2(a.outwards[1], a.outwards[0]);
  const double sign = s.radius > 0.0 ? 1.0 : -1.0;
  for (int i = 1; i < n; ++i) {
    const double angle = middle + sign * a.half * (2.0 * i / n - 1.0);
    points.push_back(
        {a.centre[0] + a.radius * std::cos(angle), a.centre[1] + a.radius * std::sin(angle)});
  }
}

}  // namespace

Outline mirrored_outline(std::span<const OutlineRow> half) {
  check_rows(half, 3);
  check_half(half);
  std::vector<Segment> segments;
  for (std::size_t i = 1; i < half.size(); ++i)
    segments.push_back({half[i - 1].point, half[i].point, half[i].radius, half[i].number});
  // Mirroring and running backwards each change the sense of turning: together, the radius stays.
  for (std::size_t i = segments.size(); i-- > 0;) {
    const Segment s = segments[i];
    segments.push_back({{-s.to[0], s.to[1]}, {-s.from[0], s.from[1]}, s.radius, s.number});
  }
  return finish(std::move(segments));
}

Outline point_outline(std::span<const OutlineRow> points) {
  if (points.size() > 1 && points.front().point == points.back().point)
    points = points.first(points.size() - 1);
  check_rows(points, 3);
  check_closing(points);
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const OutlineRow& next = points[(i + 1) % points.size()];
    segments.push_back({points[i].point, next.point, next.radius, next.number});
  }
  return finish(std::move(segments));
}

AreaProperties<double> properties(const Outline& outline) {
  const Moments m = moments_of(outline.segments);
  return {m.area, m.z / m.area, m.zz - m.z * m.z / m.area, m.yy - m.y * m.y / m.area};
}

double product_of_inertia(const Outline& outline) {
  const Moments m = moments_of(outline.segments);
  return m.yz - m.y * m.z / m.area;
}

std::vector<Point> polygon(const Outline& outline, double chord_tolerance) {
  std::vector<Point> points;
  for (const Segment& s : outline.segments) {
    points.push_back(s.from);
    if (s.radius != 0.0) append_arc(s, chord_tolerance, points);
  }
  return points;
}

}  // namespace railstep
