#pragma once
#include <array>

#include "offline/section/outline.h"
#include "offline/section/rectangles.h"

namespace railstep {

inline constexpr int kMomentDegree = 4;

/// Moments int y^i z^j dA of a section, i + j <= 4, in m^(2+i+j). Green-Lagrange strain is
/// quadratic over a section, so an element's energy needs no higher moments.
struct SectionMoments {
  std::array<std::array<double, kMomentDegree + 1>, kMomentDegree + 1> of{};  // [i][j]

  double area() const { return of[0][0]; }
  double centroid_z() const { return of[0][1] / of[0][0]; }
};

/// The same moments about an axis that lies `up` (m) above: z becomes z - up.
SectionMoments raised(const SectionMoments& moments, double up);

/// Exact moments of three rectangles about their centroid.
SectionMoments moments(const Rectangles<double>& section);

/// The same by `points` x `points` Gauss points (1 to 3) in each rectangle. Three are exact.
SectionMoments moments(const Rectangles<double>& section, int points);

/// Moments of one rectangle about its centroid, by `points` x `points` Gauss points; 3 are exact.
SectionMoments rectangle_moments(double height, double width, int points = 3);

/// Moments of an outline about its centroid, by Green's theorem with Gauss points along each
/// segment: exact for straight ones, to round-off for arcs. Odd powers of y are 0: the outline is
/// taken as symmetric about its axis. A section whose width W(z) varies (Eq. 9) is given so.
SectionMoments moments(const Outline& outline);

}  // namespace railstep
