#pragma once
#include <array>
#include <optional>

#include "offline/math/refuse.h"
#include "offline/section/outline.h"
#include "offline/section/rectangles.h"

namespace railstep {

/// Targets of the three rectangles: four properties, and the sum of their heights.
struct FitTargets {
  AreaProperties<double> area;
  double height;  // m
};

/// Thrown where no three rectangles have the targets.
struct NoSection : Failed {
  using Failed::Failed;
};

/// Signed, got / wanted - 1.
using RelativeErrors = AreaProperties<double>;

/// Three rectangles fitted to an outline, and how it went.
struct SectionFit {
  Rectangles<double> section;
  RelativeErrors errors;
  double symmetric_difference;  // m2, of outline and rectangles; NaN without an outline
  double stationarity;  // d(symmetric difference)/d(head width), m; 0 at a smooth minimum, or NaN
  int family_points;    // exact sections compared in the search over the whole family
  int iterations;       // of Ceres in the final solves
  bool from_start;      // the start given led here by itself
  /// Change of foot width and height, web width, head height (m) per unit relative error of all
  /// four properties, root of the covariance's diagonal at fixed head width: how well-posed the fit
  /// is.
  std::array<double, 4> sensitivity;
};

/// Largest of the four errors without their signs.
double largest(const RelativeErrors& errors);

/// Fits three rectangles to an outline, lexicographically: first the four properties to round-off,
/// then, among the sections that have them, the least symmetric difference with the outline on the
/// same axis and foot line. Unique: the whole family of exact sections is searched.
/// @param start  where Ceres begins, instead of at the family's best point; changes nothing but
/// time. Throws NoSection when no three rectangles have these properties.
SectionFit fit_section(const Outline& outline,
                       const std::optional<Rectangles<double>>& start = std::nullopt);

/// The section with these properties and this head width (m). Throws as above, naming the head
/// widths that can be had.
SectionFit fit_targets(const FitTargets& targets, double head_width);

/// Area of the symmetric difference, m2; `polygon` counter-clockwise about y = 0 on z = 0, `area`
/// its own.
double symmetric_difference(std::span<const Point> polygon, double area,
                            const Rectangles<double>& section);

}  // namespace railstep
