#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "offline/section/outline.h"
#include "support/random_draw.h"

namespace railstep {

/// Outlines of many kinds with random sizes, the same on every machine.
class RandomOutlines {
 public:
  explicit RandomOutlines(std::uint64_t seed) : draw_(seed) {}

  double between(double low, double high) { return draw_.between(low, high); }

  static Outline of_points(const std::vector<Point>& points) {
    std::vector<OutlineRow> rows;
    rows.reserve(points.size());
    for (const Point& p : points) rows.push_back({p, 0.0, static_cast<int>(rows.size()) + 1});
    return point_outline(rows);
  }

  /// A rectangle in whole millimetres, as in drawings.
  Outline rectangle() {
    const double b = 1e-3 * std::round(between(20, 100)), h = 1e-3 * std::round(between(20, 140));
    return of_points({{0, 0}, {b, 0}, {b, h}, {0, h}});
  }

  static Outline circle(double r) {
    const OutlineRow half[] = {{{0, 0}, 0, 1}, {{r, r}, r, 2}, {{0, 2 * r}, r, 3}};
    return mirrored_outline(half);
  }

  Outline ellipse() {
    const double a = between(.02, .1), b = between(.02, .1);
    std::vector<Point> points;
    for (int i = 0; i < 180; ++i) {
      const double angle = std::numbers::pi * i / 90;
      points.push_back({a * std::cos(angle), b * std::sin(angle)});
    }
    return of_points(points);
  }

  Outline i_shape() {
    const double foot = between(.02, .1), web = between(.004, .015), head = between(.02, .075);
    const double z1 = between(.008, .04), z2 = z1 + between(.03, .15), z3 = z2 + between(.008, .05);
    return of_points({{-foot, 0},
                      {foot, 0},
                      {foot, z1},
                      {web, z1},
                      {web, z2},
                      {head, z2},
                      {head, z3},
                      {-head, z3},
                      {-head, z2},
                      {-web, z2},
                      {-web, z1},
                      {-foot, z1}});
  }

  Outline l_shape() {
    const double b = between(.04, .15), h = between(.04, .15);
    const double foot = between(.005, .02), leg = between(.005, .02);
    return of_points({{0, 0}, {b, 0}, {b, foot}, {leg, foot}, {leg, h}, {0, h}});
  }

  Outline trapezium() {
    const double b = between(.02, .15), t = between(.02, .15), h = between(.04, .15);
    return of_points({{-b, 0}, {b, 0}, {t, h}, {-t, h}});
  }

  /// An outline like rail 59R2: 180 mm high, foot of 180 mm, head `to_the_right` (m) of the web.
  static Outline grooved(double to_the_right) {
    std::vector<Point> mm = {{-90, 0},  {90, 0},   {90, 10},  {30, 22},   {6, 32},
                             {6, 115},  {30, 125}, {75, 135}, {79, 168},  {64, 168},
                             {60, 133}, {26, 133}, {22, 180}, {-34, 180}, {-34, 145},
                             {-6, 130}, {-6, 32},  {-30, 22}, {-90, 10}};
    for (Point& p : mm)
      p = {1e-3 * p[0] + (p[1] > 120 && std::abs(p[0]) > 6 ? to_the_right : 0.0), 1e-3 * p[1]};
    return of_points(mm);
  }

 private:
  Draw draw_;
};

}  // namespace railstep
