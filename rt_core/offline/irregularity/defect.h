#pragma once
#include "offline/irregularity/spline.h"

namespace railstep {

/// Height of a railhead over its design line, up positive, at the places that a defect spans; 0
/// elsewhere. A spline of steps of `step`, averaged over a contact patch of length `patch`, which
/// rounds kinks: without one they are rounded over one step.
struct DefectGrid {
  double step;        // m
  double patch = 0.;  // m
};

/// Most steps in half of a shape or in a contact patch.
inline constexpr double kMostDefectSteps = 1e7;

/// Steps of a fourth of the patch, which smooths anything shorter, and at least 50 of them over a
/// shape of that length; 500 without a patch.
DefectGrid defect_grid(double patch, double shape);

/// A joint whose ends hang: straight ramps down to `depth` at `place`, each `ramp` long. The dip
/// angle of Jenkins and others (1974) is 2 alpha = 2 depth / ramp.
Signal dipped_joint(double place, double depth, double ramp, const DefectGrid& grid);

/// A wave of that amplitude between two places, faded in and out over one wavelength at each end
/// by a half cosine.
Signal corrugation(double from, double to, double wavelength, double amplitude,
                   const DefectGrid& grid);

/// Deviation of a wheel's tread from its radius, as a signal over its circumference, negative where
/// the wheel sits lower. It is periodic, with the defect in the middle of the turn.
///
/// A fresh flat is a chord: the wheel turns about one of its corners, then about the other, and its
/// centre falls by x^2 / (2 radius) from each, l^2 / (8 radius) in the middle. A rounded one is
/// depth / 2 (1 - cos 2 pi x / l) over its length l (Newton and Clark 1979).
/// @param grid.step  at most; made a whole part of the circumference
Signal fresh_flat(double radius, double length, const DefectGrid& grid);
Signal rounded_flat(double radius, double length, double depth, const DefectGrid& grid);

/// amplitude cos(order turn angle): eccentric (1), oval (2), polygons.
Signal out_of_round(double radius, int order, double amplitude, const DefectGrid& grid);

}  // namespace railstep
