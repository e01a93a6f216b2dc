#include <algorithm>
#include <cmath>

#include "offline/section/outline.h"

namespace railstep {
namespace {

/// Keeps the part of a polygon with sign * (coordinate - limit) <= 0 (Sutherland and Hodgman 1974).
/// Bridges along the cut enclose no area, so the area stays right for polygons that are not convex.
void clip(std::vector<Point>& points, std::size_t axis, double limit, double sign) {
  std::vector<Point> kept;
  kept.reserve(points.size() + 8);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& a = points[i];
    const Point& b = points[(i + 1) % points.size()];
    const double da = sign * (a[axis] - limit), db = sign * (b[axis] - limit);
    if (da <= 0.0) kept.push_back(a);
    if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) {
      const double t = da / (da - db);
      Point cut = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
      cut[axis] = limit;
      kept.push_back(cut);
    }
  }
  points.swap(kept);
}

/// Where the line {coordinate axis = at} crosses the polygon, sorted.
std::vector<double> crossings(std::span<const Point> polygon, std::size_t axis, double at) {
  std::vector<double> found;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    // Half open, so a corner on the line counts once, and a side along it not at all.
    if ((a[axis] < at) == (b[axis] < at)) continue;
    const double t = (at - a[axis]) / (b[axis] - a[axis]);
    found.push_back(a[1 - axis] + t * (b[1 - axis] - a[1 - axis]));
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Least and largest z.
std::array<double, 2> heights(std::span<const Point> polygon) {
  double low = polygon.front()[1], high = low;
  for (const Point& p : polygon) {
    low = std::min(low, p[1]);
    high = std::max(high, p[1]);
  }
  return {low, high};
}

}  // namespace

double area_inside(std::span<const Point> polygon, double y0, double y1, double z0, double z1) {
  std::vector<Point> points(polygon.begin(), polygon.end());
  clip(points, 1, z1, 1.0);
  clip(points, 1, z0, -1.0);
  clip(points, 0, y1, 1.0);
  clip(points, 0, y0, -1.0);
  double twice = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& a = points[i];
    const Point& b = points[(i + 1) % points.size()];
    twice += (a[0] - y0) * (b[1] - z0) - (b[0] - y0) * (a[1] - z0);
  }
  return 0.5 * twice;
}

double length_inside(std::span<const Point> polygon, int axis, double at, double from, double to) {
  const std::vector<double> found = crossings(polygon, static_cast<std::size_t>(axis), at);
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < found.size(); i += 2)
    length += std::max(0.0, std::min(found[i + 1], to) - std::max(found[i], from));
  return length;
}

double foot_middle(std::span<const Point> polygon) {
  const auto [low, high] = heights(polygon);
  const std::vector<double> found = crossings(polygon, 1, low + 0.01 * (high - low));
  return 0.5 * (found.front() + found.back());
}

double asymmetry(std::span<const Point> polygon) {
  constexpr int kLevels = 1000;
  const auto [low, high] = heights(polygon);
  double uneven = 0.0, area = 0.0;
  for (int level = 0; level < kLevels; ++level) {
    const double z = low + (level + 0.5) * (high - low) / kLevels;
    const std::vector<double> found = crossings(polygon, 1, z);
    for (std::size_t i = 0; i < found.size(); ++i) {
      uneven += std::abs(found[i] + found[found.size() - 1 - i]);
      area += i % 2 == 0 ? -found[i] : found[i];
    }
  }
  return uneven / area;
}

}  // namespace railstep
