#include "offline/section/moments.h"

#include <cmath>
#include <string>

#include "offline/math/gauss.h"
#include "offline/math/refuse.h"

namespace railstep {
namespace {

constexpr int kN = kMomentDegree;

double power(double x, int n) {
  double result = 1.;
  for (int i = 0; i < n; ++i) result *= x;
  return result;
}

double& at(SectionMoments& m, int i, int j) {
  return m.of[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
}

double at(const SectionMoments& m, int i, int j) {
  return m.of[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
}

void add_point(SectionMoments& m, double y, double z, double area) {
  for (int i = 0; i <= kN; ++i)
    for (int j = 0; i + j <= kN; ++j) at(m, i, j) += area * power(y, i) * power(z, j);
}

/// Sets the odd powers of y to exactly 0, as they are for a section symmetric about y = 0;
/// round-off would leave a rest.
void clear_odd(SectionMoments& m) {
  for (int i = 1; i <= kN; i += 2)
    for (int j = 0; i + j <= kN; ++j) at(m, i, j) = 0.;
}

SectionMoments about_centroid(const SectionMoments& m) {
  SectionMoments result = raised(m, m.centroid_z());
  result.of[0][1] = 0.;
  return result;
}

void add_rectangle(SectionMoments& m, double width, double bottom, double height, int points) {
  for (const GaussPoint& v : gauss(points))
    for (const GaussPoint& h : gauss(points))
      add_point(m, .5 * width * h.xi, bottom + .5 * height * (1. + v.xi),
                .25 * width * height * h.weight * v.weight);
}

/// Green: int y^i z^j dA = 1/(i+1) times the integral of y^(i+1) z^j dz, counter-clockwise.
void add_boundary(SectionMoments& m, const Point& p, double dz) {
  for (int i = 0; i <= kN; i += 2)
    for (int j = 0; i + j <= kN; ++j)
      at(m, i, j) += power(p[0], i + 1) * power(p[1], j) * dz / (i + 1);
}

void add_line(SectionMoments& m, const Segment& s) {
  for (const GaussPoint& g : gauss(3)) {
    const double t = .5 * (1. + g.xi);
    const Point p = {s.from[0] + t * (s.to[0] - s.from[0]), s.from[1] + t * (s.to[1] - s.from[1])};
    add_boundary(m, p, .5 * g.weight * (s.to[1] - s.from[1]));
  }
}

/// In pieces of at most 0.1 rad, over which five Gauss points leave 1e-16 of a degree 5 integrand.
void add_arc(SectionMoments& m, const Segment& s) {
  const Arc arc = arc_of(s);
  const double orientation = s.radius > 0. ? 1. : -1.;
  const double middle = std::atan2(arc.outwards[1], arc.outwards[0]);
  const int pieces = static_cast<int>(std::ceil(2. * arc.half / .1));
  const double step = 2. * arc.half / pieces;
  for (int k = 0; k < pieces; ++k)
    for (const GaussPoint& g : gauss(5)) {
      const double t = middle + orientation * (-arc.half + step * (k + .5 * (1. + g.xi)));
      const Point p = {arc.centre[0] + arc.radius * std::cos(t),
                       arc.centre[1] + arc.radius * std::sin(t)};
      add_boundary(m, p, .5 * g.weight * step * orientation * arc.radius * std::cos(t));
    }
}

void check_points(int points) {
  if (points < 1 || points > 3)
    refuse("E-SECTION-08", "points per rectangle: " + std::to_string(points) + "; expected 1 to 3");
}

}  // namespace

SectionMoments raised(const SectionMoments& moments, double up) {
  SectionMoments result;
  for (int i = 0; i <= kN; ++i)
    for (int j = 0; i + j <= kN; ++j) {
      double choose = 1.;  // of k among j
      for (int k = 0; k <= j; ++k) {
        at(result, i, j) += choose * power(-up, k) * at(moments, i, j - k);
        choose *= static_cast<double>(j - k) / (k + 1);
      }
    }
  return result;
}

SectionMoments moments(const Rectangles<double>& section, int points) {
  check_points(points);
  SectionMoments m;
  double bottom = 0.;
  for (std::size_t i = 0; i < 3; ++i) {
    add_rectangle(m, section.width[i], bottom, section.height[i], points);
    bottom += section.height[i];
  }
  clear_odd(m);
  return about_centroid(m);
}

SectionMoments moments(const Rectangles<double>& section) { return moments(section, 3); }

SectionMoments rectangle_moments(double height, double width, int points) {
  check_points(points);
  SectionMoments m;
  add_rectangle(m, width, -.5 * height, height, points);
  clear_odd(m);
  for (int i = 0; i <= kN; i += 2)
    for (int j = 1; i + j <= kN; j += 2) at(m, i, j) = 0.;
  return m;
}

SectionMoments moments(const Outline& outline) {
  SectionMoments m;
  for (const Segment& s : outline.segments)
    if (s.radius == 0.)
      add_line(m, s);
    else
      add_arc(m, s);
  clear_odd(m);
  return about_centroid(m);
}

}  // namespace railstep
