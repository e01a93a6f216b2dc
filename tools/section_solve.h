#pragma once
#include "section_fit.h"

namespace railstep {

// The two levels of the fit as Ceres problems; section_fit.cpp says where each begins.

/// Level 1: moves `section` to one with the targets, its web height eliminated so that the heights
/// add up. With `head_width_fixed` four unknowns for four properties (regular away from the
/// family's fold), else five (the nearest in Ceres's own metric). Returns false, `section`
/// unchanged, where the largest error stays over 1e-9 or a dimension is not positive. Adds to
/// `iterations`.
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

/// The least-squares compromise for targets that no exact section has.
Rectangles<double> closest(const FitTargets& targets);

/// Root of the diagonal of (J'J)^-1, J = d(relative errors)/d(foot width, height, web width, head
/// height), m.
std::array<double, 4> sensitivity(const FitTargets& targets, const Rectangles<double>& section);

RelativeErrors relative_errors(const FitTargets& targets, const Rectangles<double>& section);

}  // namespace railstep
