#pragma once
#include "section/section_fit.h"

namespace railstep {

// The two levels of the fit as Ceres problems; section_fit.cpp says where each begins.

/// The least height of a part, of the whole. A lower one has next to no share in the properties, so
/// that its width could be anything.
inline constexpr double kThinnest = 1e-3;

/// The largest relative error of a section that has the targets.
inline constexpr double kExact = 1e-9;

/// True where every width is above 0 and every height at least kThinnest of the whole.
bool is_section(const Rectangles<double>& section);

/// Level 1: moves `section` to one with the targets, its web height eliminated so that the heights
/// add up. With `head_width_fixed` four unknowns for four properties (regular away from the
/// family's fold), else five (the nearest in Ceres's own metric). Returns false, `section`
/// unchanged, where the largest error stays over kExact or where what is found fails
/// is_section(). Adds to `iterations`.
bool solve_exact(const FitTargets& targets, bool head_width_fixed, Rectangles<double>& section,
                 int& iterations);

/// d(symmetric difference)/d(head width) along the family of exact sections, m: lengths of the
/// rectangles' borders inside the outline, by the family's tangent.
double slope(const FitTargets& targets, std::span<const Point> polygon,
             const Rectangles<double>& section);

/// Level 2: from an exact section downhill along the family to where the slope is zero or changes
/// sign. Returns false, `section` at the last one reached, where the family ends before that.
bool descend(const FitTargets& targets, std::span<const Point> polygon, Rectangles<double>& section,
             int& iterations);

/// The compromise for targets that no exact section has: the least sum of the four relative errors'
/// squares, the least of what many starts lead to.
Rectangles<double> closest(const FitTargets& targets);

/// Root of the diagonal of (J'J)^-1, J = d(relative errors)/d(foot width, height, web width, head
/// height), m.
std::array<double, 4> sensitivity(const FitTargets& targets, const Rectangles<double>& section);

RelativeErrors relative_errors(const FitTargets& targets, const Rectangles<double>& section);

}  // namespace railstep
