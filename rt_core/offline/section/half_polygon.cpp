#include "offline/section/half_polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "offline/math/refuse.h"
#include "offline/section/outline.h"

namespace railstep {
namespace {

/// Twice the signed area of the triangle a, b, c.
double cross(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Width plus height; NaN or infinity when a coordinate is not finite.
double extent(const std::vector<Point>& polygon) {
  double total = 0.0;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    double low = polygon[0][axis];
    double high = low;
    for (const Point& p : polygon) {
      if (!std::isfinite(p[axis])) return std::numeric_limits<double>::quiet_NaN();
      low = std::min(low, p[axis]);
      high = std::max(high, p[axis]);
    }
    total += high - low;
  }
  return total;
}

double signed_area(const std::vector<Point>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross(polygon[0], polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * twice;
}

/// True when the segments ab and cd share a point, collinear overlap included.
bool touch(const Point& a, const Point& b, const Point& c, const Point& d) {
  for (std::size_t axis = 0; axis < 2; ++axis)
    if (std::max(a[axis], b[axis]) < std::min(c[axis], d[axis]) ||
        std::max(c[axis], d[axis]) < std::min(a[axis], b[axis]))
      return false;
  return cross(a, b, c) * cross(a, b, d) <= 0.0 && cross(c, d, a) * cross(c, d, b) <= 0.0;
}

bool crosses_itself(const std::vector<Point>& polygon) {
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;  // neighbours share their point
      if (touch(polygon[i], polygon[i + 1], polygon[j], polygon[(j + 1) % n])) return true;
    }
  return false;
}

/// True when the mirrored outline runs through the same points backwards.
bool is_symmetric(const std::vector<Point>& polygon, double tolerance) {
  const std::size_t n = polygon.size();
  const auto mirrored = [&](std::size_t i, std::size_t j) {
    return std::hypot(polygon[i][0] + polygon[j][0], polygon[i][1] - polygon[j][1]) <= tolerance;
  };
  for (std::size_t start = 0; start < n; ++start) {
    std::size_t i = 0;
    while (i < n && mirrored(i, (start + n - i) % n)) ++i;
    if (i == n) return true;
  }
  return false;
}

}  // namespace

void check_polygon(const std::vector<Point>& polygon) {
  if (polygon.size() < 3)
    refuse("E-SECTION-01",
           "the section has " + std::to_string(polygon.size()) + " points; expected 3 or more");
  const double size = extent(polygon);
  if (!std::isfinite(size))
    refuse("E-SECTION-02", "a coordinate of the section is not finite; expected finite numbers");
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& next = polygon[(i + 1) % polygon.size()];
    if (std::hypot(next[0] - polygon[i][0], next[1] - polygon[i][1]) <= 1e-9 * size)
      refuse("E-SECTION-03",
             "two consecutive points of the section coincide; expected different points, and the "
             "first one not repeated at the end");
  }
  if (signed_area(polygon) <= 1e-9 * size * size)
    refuse("E-SECTION-04",
           "the section encloses no area or its points run clockwise; expected points in "
           "counter-clockwise order around it");
  if (crosses_itself(polygon))
    refuse("E-SECTION-05",
           "the outline of the section crosses itself; expected points in order around it");
}

namespace {

/// The outline with its points near the axis put on it, and points added where it crosses the axis.
std::vector<Point> with_axis_points(const std::vector<Point>& polygon) {
  const double tolerance = 1e-6 * extent(polygon);
  std::vector<Point> all;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    Point a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    if (std::abs(a[0]) <= tolerance) a[0] = 0.0;
    all.push_back(a);
    if (a[0] * b[0] < 0.0 && std::abs(b[0]) > tolerance)
      all.push_back({0.0, a[1] + (b[1] - a[1]) * a[0] / (a[0] - b[0])});
  }
  return all;
}

}  // namespace

HalfPolygon right_half(const std::vector<Point>& polygon) {
  check_polygon(polygon);
  if (!is_symmetric(polygon, 1e-6 * extent(polygon)))
    refuse("E-SECTION-06",
           "the section is not symmetric about y = 0; expected a symmetric section");
  const std::vector<Point> all = with_axis_points(polygon);
  const std::size_t n = all.size();
  std::size_t first = n;
  std::size_t departures = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (all[i][0] == 0.0 && all[(i + 1) % n][0] > 0.0) {
      first = i;
      ++departures;
    }
  if (departures != 1)
    refuse("E-SECTION-07",
           "the outline does not cross its upright axis exactly twice; expected one crossing at "
           "the foot and one at the crown");
  HalfPolygon half{all[first]};
  for (std::size_t i = first + 1; half.size() == 1 || half.back()[0] > 0.0; ++i)
    half.push_back(all[i % n]);
  return half;
}

bool is_inside(const std::vector<Point>& polygon, const Point& point) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Point& a = polygon[i];
    const Point& b = polygon[j];
    if ((a[1] > point[1]) == (b[1] > point[1])) continue;
    if (point[0] < a[0] + (b[0] - a[0]) * (point[1] - a[1]) / (b[1] - a[1])) inside = !inside;
  }
  return inside;
}

}  // namespace railstep
