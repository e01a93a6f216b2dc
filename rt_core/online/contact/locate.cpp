#include "online/contact/locate.h"

#include <cmath>

#include "online/math/vector3.h"

namespace railstep {
namespace {

/// r, a and b at a place, with derivatives by xi.
struct Frame {
  Vector3 r, a, b, r1, a1, b1, r2, b2;
};

Vector3 blend(const double* node, const double* N) noexcept {
  return N[0] * vector3(node) + N[1] * vector3(node + 9) + N[2] * vector3(node + 18);
}

Frame frame(const RailShape& rail, RailPlace at) noexcept {
  const double xi = at.xi;
  const double N[3] = {-0.5 * xi * (1.0 - xi), (1.0 - xi) * (1.0 + xi), 0.5 * xi * (1.0 + xi)};
  const double N1[3] = {xi - 0.5, -2.0 * xi, xi + 0.5};
  const double N2[3] = {1.0, -2.0, 1.0};
  const double* node = rail.nodes + static_cast<std::int64_t>(rail.stride) * at.element;
  return {blend(node, N),      blend(node + 3, N),  blend(node + 6, N), blend(node, N1),
          blend(node + 3, N1), blend(node + 6, N1), blend(node, N2),    blend(node + 6, N2)};
}

/// Sample of a search at a place: `value` > 0 if the solution lies ahead, `slope` its decrease over
/// xi, or a positive substitute (`exact` false) if the slope would lead away.
struct Sample {
  double value, slope;
  bool exact;
};

Sample sample(double value, double slope, double substitute) noexcept {
  // Below a tenth of the straight rail's slope the point is near the centre of curvature.
  const bool exact = slope > 0.1 * substitute;
  return {value, exact ? slope : substitute, exact};
}

struct Found {
  LocateStatus status;
  int steps;
  RailPlace place;
};

/// Position along the rail in elements, for ordering only.
double along(RailPlace at) noexcept { return at.element + 0.5 * (at.xi + 1.0); }

/// The place at `s` elements, the element before a border if `s` falls on one.
RailPlace place_at(double s, int elements) noexcept {
  int element = static_cast<int>(s);
  if (element > elements - 1) element = elements - 1;
  return {element, 2.0 * (s - element) - 1.0};
}

RailPlace clipped(RailPlace at, int elements) noexcept {
  if (at.element < 0) return {0, -1.0};
  if (at.element >= elements) return {elements - 1, 1.0};
  const double xi = at.xi;
  return {at.element, xi >= -1.0 && xi <= 1.0 ? xi : xi > 1.0 ? 1.0 : xi < -1.0 ? -1.0 : 0.0};
}

/// Root of a falling function along the rail, by Newton inside the bracket of signs.
template <typename Ask>
Found search(int elements, RailPlace at, int cap, Ask ask) noexcept {
  constexpr double kQuadratic = 1e-9;  // a Newton step this short leaves 1e-18 times a curvature
  constexpr double kRounding = 1e-14;
  double low = -1.0, high = elements + 1.0;       // outside: not visited yet
  int low_element = -1, high_element = elements;  // that saw them
  cap = cap < 1 ? 1 : cap > kLocateSteps ? kLocateSteps : cap;
  bool hopped = false;  // came from the other side of this border, which pointed here
  for (int steps = 1; steps <= cap; ++steps) {
    const Sample got = ask(at);
    const double step = got.value / got.slope;
    if (!std::isfinite(step)) return {LocateStatus::cap_reached, steps, at};
    const bool ahead = step > 0.0;
    const double target = at.xi + step;
    if (std::fabs(step) <= (got.exact ? kQuadratic : kRounding) && std::fabs(target) <= 1.0)
      return {LocateStatus::found, steps, {at.element, target}};

    const bool on_border = at.xi == (ahead ? 1.0 : -1.0);
    const int next = at.element + (ahead ? 1 : -1);
    if (on_border && (hopped || std::fabs(step) <= kEndSlack))
      return {LocateStatus::found, steps, at};
    if (on_border && (next < 0 || next >= elements))
      return {ahead ? LocateStatus::off_end : LocateStatus::off_start, steps, at};
    (ahead ? low : high) = along(at);
    (ahead ? low_element : high_element) = at.element;
    hopped = false;
    if (on_border) {
      at = {next, ahead ? -1.0 : 1.0};
      hopped = true;
      continue;
    }

    if (std::fabs(target) <= 1.0) {
      const double s = along({at.element, target});
      at = s > low && s < high ? RailPlace{at.element, target}
                               : place_at(0.5 * (low + high), elements);
      continue;
    }
    // Across a border. If the far side is known to point back, stop on the border.
    const bool visited = next == (ahead ? high_element : low_element);
    const double s = along(at) + 0.5 * step;
    if (next < 0 || next >= elements)
      at.xi = ahead ? 1.0 : -1.0;
    else if (visited)
      at = {next, ahead ? -1.0 : 1.0};
    else if (s <= 0.0 || s >= elements)
      at = ahead ? RailPlace{elements - 1, 1.0} : RailPlace{0, -1.0};
    else
      at = s > low && s < high ? place_at(s, elements) : place_at(0.5 * (low + high), elements);
  }
  return {LocateStatus::cap_reached, cap, at};
}

double finite_or_zero(double x) noexcept { return std::isfinite(x) ? x : 0.0; }

}  // namespace

PointOnRail locate_point(const RailShape& rail, const double* point, RailPlace start,
                         int cap) noexcept {
  const Vector3 X = vector3(point);
  const Found found =
      search(rail.elements, clipped(start, rail.elements), cap, [&](RailPlace at) noexcept {
        const Frame f = frame(rail, at);
        const Vector3 n = cross(f.a, f.b), n1 = cross(f.a1, f.b) + cross(f.a, f.b1);
        const double straight = dot(f.r1, n);
        return sample(dot(X - f.r, n), straight - dot(X - f.r, n1), straight);
      });
  const Frame f = frame(rail, found.place);
  const Vector3 n = cross(f.a, f.b), d = X - f.r;
  const double size = dot(n, n);
  const double y = finite_or_zero(dot(cross(d, f.b), n) / size);
  const double z = finite_or_zero(dot(cross(f.a, d), n) / size);
  const Vector3 miss = d - (y * f.a + z * f.b);
  return {found.status, found.steps, found.place, y, z, finite_or_zero(std::sqrt(dot(miss, miss)))};
}

WheelOnRail locate_wheel(const RailShape& rail, const double* p, const double* e, double z_crown,
                         RailPlace start, int cap) noexcept {
  const Vector3 axle = vector3(p), direction = vector3(e);
  const auto across = [&](Vector3 v) noexcept { return v - dot(direction, v) * direction; };
  const Found found =
      search(rail.elements, clipped(start, rail.elements), cap, [&](RailPlace at) noexcept {
        const Frame f = frame(rail, at);
        const Vector3 w = across(f.r + z_crown * f.b - axle);
        const Vector3 c1 = f.r1 + z_crown * f.b1, c2 = f.r2 + z_crown * f.b2;
        const Vector3 across1 = across(c1);
        const double straight = dot(across1, across1);
        return sample(-dot(w, c1), straight + dot(w, c2), straight);
      });
  const Frame f = frame(rail, found.place);
  const Vector3 c = f.r + z_crown * f.b - axle, w = across(c);
  const double distance = finite_or_zero(std::sqrt(dot(w, w)));
  const double scale = distance > 0.0 ? -1.0 / distance : 0.0;
  return {found.status,
          found.steps,
          found.place,
          distance,
          {finite_or_zero(scale * w.x), finite_or_zero(scale * w.y), finite_or_zero(scale * w.z)},
          finite_or_zero(dot(direction, c))};
}

}  // namespace railstep
