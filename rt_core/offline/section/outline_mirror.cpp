#include "offline/section/outline_mirror.h"

#include <algorithm>
#include <cmath>

#include "offline/math/refuse.h"

namespace railstep {
namespace {

double off_chord(const Point& a, const Point& b, const Point& p) {
  const double y = b[0] - a[0], z = b[1] - a[1], length = std::hypot(y, z);
  if (length == 0.0) return std::hypot(p[0] - a[0], p[1] - a[1]);
  return std::abs(y * (p[1] - a[1]) - z * (p[0] - a[0])) / length;
}

/// Keeps both ends, and between them the points no chord may skip. A stack, not recursion, since a
/// spiral of 20 000 points would go that deep.
std::vector<Point> simplify(const std::vector<Point>& chain, double tolerance) {
  std::vector<bool> kept(chain.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, chain.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double farthest = tolerance;
    std::size_t split = 0;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double off = off_chord(chain[first], chain[last], chain[i]);
      if (off > farthest) {
        farthest = off;
        split = i;
      }
    }
    if (split == 0) continue;
    kept[split] = true;
    open.emplace_back(first, split);
    open.emplace_back(split, last);
  }
  std::vector<Point> result;
  for (std::size_t i = 0; i < chain.size(); ++i)
    if (kept[i]) result.push_back(chain[i]);
  return result;
}

/// The chain with y > 0 between its two points on the axis.
std::vector<Point> right_chain(const std::vector<Point>& points) {
  const std::size_t n = points.size();
  std::size_t enters = n, changes = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const bool here = points[i][0] > 0.0, next = points[(i + 1) % n][0] > 0.0;
    if (here != next) ++changes;
    if (!here && next) enters = i;
  }
  if (changes != 2)
    refuse("E-SECTION-07",
           "the outline does not cross its upright axis exactly twice; expected one crossing at "
           "the foot and one at the crown");
  const auto on_axis = [](const Point& a, const Point& b) {
    const double t = a[0] / (a[0] - b[0]);
    return Point{0.0, a[1] + t * (b[1] - a[1])};
  };
  std::vector<Point> chain = {on_axis(points[enters], points[(enters + 1) % n])};
  std::size_t i = (enters + 1) % n;
  for (; points[i][0] > 0.0; i = (i + 1) % n) chain.push_back(points[i]);
  chain.push_back(on_axis(points[(i + n - 1) % n], points[i]));
  return chain;
}

}  // namespace

std::vector<Point> simplified(std::span<const Point> polygon, double tolerance) {
  std::vector<Point> round(polygon.begin(), polygon.end());
  round.push_back(round.front());
  std::vector<Point> kept = simplify(round, tolerance);
  kept.pop_back();
  return kept;
}

std::vector<Point> mirrored_side(std::span<const Point> polygon, int side, double tolerance) {
  std::vector<Point> points(polygon.begin(), polygon.end());
  if (side < 0) {
    for (Point& p : points) p[0] = -p[0];
    std::reverse(points.begin(), points.end());
  }
  const std::vector<Point> half = simplify(right_chain(points), tolerance);
  std::vector<Point> all = half;
  for (std::size_t i = half.size() - 1; i-- > 1;) all.push_back({-half[i][0], half[i][1]});
  return all;
}

}  // namespace railstep
