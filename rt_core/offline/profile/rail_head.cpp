#include "offline/profile/rail_head.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "offline/math/constants.h"
#include "offline/math/refuse.h"

namespace railstep {

namespace {

constexpr double kSteepest = 89.5 * std::numbers::pi / 180.;  // rad: the surface ends there
constexpr double kFarJoint = 1e-4;                            // m
constexpr double kSteepestChord = 5.67;                       // tangent of 80 degrees

/// Segments of the right half of the head: arcs from the crown downwards, then the straight side.
std::vector<Segment> right_half(const Outline& outline) {
  const auto& all = outline.segments;
  const auto top = std::find_if(all.begin(), all.end(), [&](const Segment& s) {
    return std::abs(s.to[0]) < 1e-6 && std::abs(s.to[1] - outline.height) < 1e-9;
  });
  if (top == all.end())
    refuse("E-HEAD-01",
           "the outline has no point at the middle of its crown; expected a symmetric "
           "rail");
  std::vector<Segment> half;
  for (auto s = std::make_reverse_iterator(top + 1); s != all.rend(); ++s) {
    half.push_back(*s);
    if (s->radius <= 0.) break;
  }
  if (half.size() < 3 || half.back().radius != 0.)
    refuse("E-HEAD-02",
           "the head is not a crown, at least one more arc and a straight side; "
           "expected these");
  return half;
}

/// The last arc: inside the one above it, and along the side.
HeadArc last_arc(const HeadArc& above, double radius, const Segment& side) {
  const double length = distance(side.from, side.to);
  const double along[2] = {(side.to[0] - side.from[0]) / length,
                           (side.to[1] - side.from[1]) / length};
  const double out[2] = {along[1], -along[0]};  // the outline has its steel on the left
  // The centre is on the line at `radius` from the side, and `apart` from the other centre.
  const double start[2] = {side.to[0] - radius * out[0] - above.centre[0],
                           side.to[1] - radius * out[1] - above.centre[1]};
  const double apart = above.radius - radius;
  const double b = start[0] * along[0] + start[1] * along[1];
  const double c = start[0] * start[0] + start[1] * start[1] - apart * apart;
  if (!(apart > 0.) || b * b < c)
    refuse("E-HEAD-03",
           "no arc of the head's last radius is tangent to its side and to the arc "
           "above");
  const double t = -b + std::sqrt(b * b - c);
  const Point centre{above.centre[0] + start[0] + t * along[0],
                     above.centre[1] + start[1] + t * along[1]};
  return {centre, radius, std::atan2(centre[0] - above.centre[0], centre[1] - above.centre[1]),
          std::atan2(out[0], out[1])};
}

void check_joint(const HeadArc& arc, const Point& drawn) {
  const Point joint{arc.centre[0] + arc.radius * std::sin(arc.to),
                    arc.centre[1] + arc.radius * std::cos(arc.to)};
  if (!(distance(joint, drawn) < kFarJoint))
    refuse("E-HEAD-04", "the tangent arc of radius " + std::to_string(1e3 * arc.radius) +
                            " mm ends " + std::to_string(1e3 * distance(joint, drawn)) +
                            " mm from the end in the outline; expected at most 0.1 mm");
}

std::array<double, 2> turned(const Point& p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {p[0] * c - p[1] * s, p[0] * s + p[1] * c};
}

Point on_arc(const HeadArc& arc, double angle) {
  return {arc.centre[0] + arc.radius * std::sin(angle),
          arc.centre[1] + arc.radius * std::cos(angle)};
}

/// The innermost place of a turned head within kGaugeDepth below its top.
double innermost(const RailHead& head, double top) {
  double least = head.arcs.front().centre[0];
  const double lowest = top - kGaugeDepth;
  for (const HeadArc& arc : head.arcs) {
    // Angles at which the arc is above the lowest point, on its inner side.
    const double cosine = std::clamp((lowest - arc.centre[1]) / arc.radius, -1., 1.);
    const double steepest = std::min(std::acos(cosine), .5 * std::numbers::pi);
    const double angle = std::clamp(-steepest, arc.from, arc.to);
    const Point p = on_arc(arc, angle);
    if (p[1] >= lowest - 1e-9) least = std::min(least, p[0]);
  }
  // The side goes on below the arcs and may lean outwards.
  const HeadArc& inner = head.arcs.front();
  const Point end = on_arc(inner, inner.from);
  if (end[1] > lowest && inner.from > -.5 * std::numbers::pi) {
    const double down = std::min(head.side_length, (end[1] - lowest) / -std::sin(inner.from));
    least = std::min(least, end[0] - down * std::cos(inner.from));
  }
  return least;
}

/// The straight side below an end of the arcs; nothing where it is too steep for a height over y.
void add_side(const Point& end, double angle, double length, std::vector<SurfacePiece>& pieces) {
  if (!(std::abs(angle) < kSteepest)) return;
  const double to = end[0] + (angle > 0. ? 1. : -1.) * length * std::cos(angle);
  pieces.push_back(
      {std::min(end[0], to), std::max(end[0], to), end[0], 0., 0., {end[1], -std::tan(angle)}});
}

}  // namespace

RailHead tangent_head(const Outline& outline) {
  const std::vector<Segment> half = right_half(outline);
  const Segment& side = half.back();
  std::vector<HeadArc> right;
  for (std::size_t i = 0; i + 1 < half.size(); ++i) {
    const double radius = half[i].radius;
    const double from = right.empty() ? 0. : right.back().to;
    if (i + 2 == half.size()) {
      right.push_back(last_arc(right.back(), radius, side));
      right[i - 1].to = right.back().from;
      check_joint(right[i - 1], half[i].to);
      check_joint(right.back(), side.to);
      break;
    }
    const Point above = right.empty() ? Point{0., outline.height} : right.back().centre;
    const double apart = right.empty() ? -radius : right.back().radius - radius;
    const Point centre{above[0] + apart * std::sin(from), above[1] + apart * std::cos(from)};
    const double sine = (half[i].from[0] - centre[0]) / radius;
    if (!(sine > std::sin(from) && sine < 1.))
      refuse("E-HEAD-05", "the arc of radius " + std::to_string(1e3 * radius) +
                              " mm of the head ends before it begins; expected arcs that fall from "
                              "the crown to the side");
    right.push_back({centre, radius, from, std::asin(sine)});
    if (i + 3 < half.size()) check_joint(right.back(), half[i].from);
  }
  RailHead head{{}, distance(side.from, side.to)};
  for (std::size_t i = right.size(); i-- > 1;)
    head.arcs.push_back(
        {{-right[i].centre[0], right[i].centre[1]}, right[i].radius, -right[i].to, -right[i].from});
  head.arcs.push_back({right[0].centre, right[0].radius, -right[0].to, right[0].to});
  head.arcs.insert(head.arcs.end(), right.begin() + 1, right.end());
  return head;
}

RunningSurface placed(const RailHead& head, const RailPlace& place) {
  const double angle = std::atan(place.inclination);
  RailHead turned_head = head;
  double top = -1e9;
  for (HeadArc& arc : turned_head.arcs) {
    arc.centre = turned(arc.centre, angle);
    arc.from -= angle;
    arc.to -= angle;
    top = std::max(top, on_arc(arc, std::clamp(0., arc.from, arc.to))[1]);
  }
  const double y = .5 * place.gauge - innermost(turned_head, top);
  for (HeadArc& arc : turned_head.arcs) arc.centre = {arc.centre[0] + y, arc.centre[1] - top};
  std::vector<SurfacePiece> pieces;
  const HeadArc &inner = turned_head.arcs.front(), &outer = turned_head.arcs.back();
  add_side(on_arc(inner, inner.from), inner.from, head.side_length, pieces);
  for (const HeadArc& arc : turned_head.arcs) {
    const double from = std::max(arc.from, -kSteepest), to = std::min(arc.to, kSteepest);
    if (!(from < to)) continue;
    pieces.push_back({pieces.empty() ? on_arc(arc, from)[0] : pieces.back().to,
                      on_arc(arc, to)[0],
                      arc.centre[0],
                      arc.centre[1],
                      arc.radius,
                      {}});
  }
  add_side(on_arc(outer, outer.to), outer.to, head.side_length, pieces);
  return RunningSurface(std::move(pieces));
}

RunningSurface placed(std::span<const Point> head, const RailPlace& place) {
  const double angle = std::atan(place.inclination);
  std::vector<Point> points;
  for (const Point& p : head) points.push_back(turned(p, angle));
  if (points.size() < 4)
    refuse("E-HEAD-06",
           "the head has " + std::to_string(points.size()) + " points; expected at least 4");
  const auto higher = [](const Point& a, const Point& b) { return a[1] < b[1]; };
  const auto top = std::max_element(points.begin(), points.end(), higher);
  const double lowest = (*top)[1] - kGaugeDepth;
  if (points.front()[1] > lowest)
    refuse("E-HEAD-07", "the head's points end " +
                            std::to_string(1e3 * ((*top)[1] - points.front()[1])) +
                            " mm below its top on the inner side; expected at least 14 mm, where "
                            "the gauge is measured");
  double inner = (*top)[0];
  for (auto p = points.begin(); p != top; ++p) {
    const Point &a = *p, &b = *(p + 1);
    if (b[1] < lowest) continue;
    const double part = a[1] < lowest ? (lowest - a[1]) / (b[1] - a[1]) : 0.;
    inner = std::min({inner, a[0] + part * (b[0] - a[0]), b[0]});
  }
  const auto flat = [](const Point& a, const Point& b) {
    return std::abs(b[1] - a[1]) < kSteepestChord * (b[0] - a[0]);
  };
  auto from = top, to = top;
  while (from != points.begin() && flat(*(from - 1), *from)) --from;
  while (to + 1 != points.end() && flat(*to, *(to + 1))) ++to;
  std::vector<Point> surface(from, to + 1);
  for (Point& p : surface) p = {p[0] + .5 * place.gauge - inner, p[1] - (*top)[1]};
  return through(surface);
}

}  // namespace railstep
