#include "offline/section/outline_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "offline/math/refuse.h"

namespace railstep {
namespace {

constexpr double kSamePlace = 1e-8;      // m; drawings are rounded to 1e-6 m
constexpr double kLargestRadius = 10.0;  // m
constexpr std::size_t kMostPoints = 20000;

std::string millimetres(double metres) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g mm", 1e3 * metres);
  return text;
}

/// A straight piece of a segment.
struct Chord {
  Point a, b;
  std::size_t place;  // among all chords, in order of travel
  int number;         // of the segment
};

/// Twice the signed area of abc.
double orientation(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool overlap(double a0, double a1, double b0, double b1) {
  return std::max(std::min(a0, a1), std::min(b0, b1)) <=
         std::min(std::max(a0, a1), std::max(b0, b1));
}

/// True where two chords share a point; by the signs of four areas, boxes for the parallel case.
bool meet(const Chord& p, const Chord& q) {
  if (!overlap(p.a[0], p.b[0], q.a[0], q.b[0]) || !overlap(p.a[1], p.b[1], q.a[1], q.b[1]))
    return false;
  const double d1 = orientation(p.a, p.b, q.a), d2 = orientation(p.a, p.b, q.b);
  const double d3 = orientation(q.a, q.b, p.a), d4 = orientation(q.a, q.b, p.b);
  const auto same_side = [](double u, double v) {
    return (u > 0.0 && v > 0.0) || (u < 0.0 && v < 0.0);
  };
  return !same_side(d1, d2) && !same_side(d3, d4);
}

/// True where q, which starts at p's end, runs back over p.
bool folds_back(const Chord& p, const Chord& q) {
  const double py = p.b[0] - p.a[0], pz = p.b[1] - p.a[1];
  const double qy = q.b[0] - q.a[0], qz = q.b[1] - q.a[1];
  const double scale = std::hypot(py, pz) * std::hypot(qy, qz);
  return py * qy + pz * qz < 0.0 && std::abs(py * qz - pz * qy) < 1e-12 * scale;
}

std::vector<Chord> chords_of(const std::vector<Segment>& segments) {
  std::vector<Chord> chords;
  for (const Segment& s : segments) {
    const std::vector<Point> points = polygon(Outline{{s}, 0.0}, 1e-6);
    for (std::size_t i = 0; i < points.size(); ++i)
      chords.push_back(
          {points[i], i + 1 < points.size() ? points[i + 1] : s.to, chords.size(), s.number});
  }
  return chords;
}

[[noreturn]] void refuse_crossing(const Chord& p, const Chord& q) {
  const Point where = p.a;
  refuse("E-SECTION-10", "the outline crosses itself: the segments that end at rows " +
                             std::to_string(std::min(p.number, q.number)) + " and " +
                             std::to_string(std::max(p.number, q.number)) + " meet near (" +
                             millimetres(where[0]) + ", " + millimetres(where[1]) +
                             "); expected an outline that does not cross itself");
}

}  // namespace

void check_rows(std::span<const OutlineRow> rows, std::size_t fewest) {
  for (const OutlineRow& row : rows)
    if (!std::isfinite(row.point[0]) || !std::isfinite(row.point[1]) || !std::isfinite(row.radius))
      refuse("E-SECTION-11",
             "row " + std::to_string(row.number) +
                 " of the outline holds a value that is not finite; expected finite numbers");
  if (rows.size() < fewest)
    refuse("E-SECTION-12", "the outline has " + std::to_string(rows.size()) +
                               " points; expected at least " + std::to_string(fewest));
  if (rows.size() > kMostPoints)
    refuse("E-SECTION-13", "the outline has " + std::to_string(rows.size()) +
                               " points; expected at most " + std::to_string(kMostPoints));
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (distance(rows[i - 1].point, rows[i].point) < kSamePlace)
      refuse("E-SECTION-14", "rows " + std::to_string(rows[i - 1].number) + " and " +
                                 std::to_string(rows[i].number) +
                                 " of the outline are the same point; remove one of them");
}

void check_half(std::span<const OutlineRow> half) {
  for (const OutlineRow* end : {&half.front(), &half.back()})
    if (std::abs(end->point[0]) > kSamePlace)
      refuse("E-SECTION-15",
             "the half outline leaves a gap: its row " + std::to_string(end->number) + " is " +
                 millimetres(end->point[0]) +
                 " off the axis x = 0; expected its first and last rows on that axis");
  for (const OutlineRow& row : half)
    if (row.point[0] < -kSamePlace)
      refuse("E-SECTION-16", "row " + std::to_string(row.number) + " of the half outline is " +
                                 millimetres(-row.point[0]) +
                                 " left of the axis x = 0; expected x of 0 or more");
}

void check_closing(std::span<const OutlineRow> points) {
  double longest = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    longest = std::max(longest, distance(points[i - 1].point, points[i].point));
  const double closing = distance(points.front().point, points.back().point);
  if (closing < kSamePlace)
    refuse("E-SECTION-17",
           "rows " + std::to_string(points.front().number) + " and " +
               std::to_string(points.back().number) +
               " of the outline are nearly, but not exactly, the same point; remove the last row");
  if (closing > 3.0 * longest)
    refuse("E-SECTION-18", "the outline has a gap of " + millimetres(closing) +
                               " between its last and first points, over three times its longest "
                               "side; list the full outline");
}

void check_segment(const Segment& s) {
  const double chord = distance(s.from, s.to);
  // The moments of a flatter arc drown in round-off: at 10 m they still hold to 2e-10.
  if (std::abs(s.radius) > kLargestRadius)
    refuse("E-SECTION-19", "row " + std::to_string(s.number) + " has an arc radius of " +
                               millimetres(std::abs(s.radius)) + "; expected at most " +
                               millimetres(kLargestRadius) + ", or 0 for a straight line");
  // A semicircle is allowed, up to the rounding of printed coordinates.
  if (s.radius != 0.0 && std::abs(s.radius) < 0.5 * chord * (1.0 - 1e-9))
    refuse("E-SECTION-20", "row " + std::to_string(s.number) + " has an arc radius of " +
                               millimetres(std::abs(s.radius)) + ", under half its chord of " +
                               millimetres(chord) + "; expected " + millimetres(0.5 * chord) +
                               " or more, or 0 for a straight line");
}

void check_size(double width, double height) {
  char text[120];
  for (const auto& [size, way] : {std::pair(height, "high"), std::pair(width, "wide")}) {
    if (!(size <= 1.0)) {
      std::snprintf(text, sizeof text,
                    "the outline is %.6g m %s; expected at most 1 m: are these millimetres?", size,
                    way);
      refuse("E-SECTION-21", text);
    }
  }
  if (!(height > 1e-3)) {
    std::snprintf(text, sizeof text,
                  "the outline is %.6g mm high; expected over 1 mm: are these metres?",
                  1e3 * height);
    refuse("E-SECTION-22", text);
  }
}

void check_crossing(const std::vector<Segment>& segments) {
  std::vector<Chord> chords = chords_of(segments);
  const std::size_t n = chords.size();
  for (std::size_t i = 0; i < n; ++i)
    if (folds_back(chords[i], chords[(i + 1) % n])) refuse_crossing(chords[i], chords[(i + 1) % n]);
  // Sweep along z: only chords whose heights overlap are compared.
  std::sort(chords.begin(), chords.end(), [](const Chord& p, const Chord& q) {
    return std::min(p.a[1], p.b[1]) < std::min(q.a[1], q.b[1]);
  });
  for (std::size_t i = 0; i < n; ++i) {
    const double top = std::max(chords[i].a[1], chords[i].b[1]);
    for (std::size_t j = i + 1; j < n && std::min(chords[j].a[1], chords[j].b[1]) <= top; ++j) {
      const std::size_t spacing = chords[i].place > chords[j].place
                                      ? chords[i].place - chords[j].place
                                      : chords[j].place - chords[i].place;
      if (spacing == 1 || spacing == n - 1) continue;  // neighbours share a point
      if (meet(chords[i], chords[j])) refuse_crossing(chords[i], chords[j]);
    }
  }
}

}  // namespace railstep
