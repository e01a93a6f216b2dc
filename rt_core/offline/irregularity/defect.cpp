#include "offline/irregularity/defect.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "offline/irregularity/sincos.h"
#include "offline/math/refuse.h"

namespace railstep {

namespace {

int whole_steps(double length, double step) {
  if (!(length > 0.) || !(step > 0.) || !(length / step < kMostDefectSteps))
    refuse("E-IRREGULARITY-01",
           "the length or the step of a defect is out of range; expected both above 0, and fewer "
           "than 1e7 steps");
  return static_cast<int>(std::ceil(length / step * (1. - 1e-12)));
}

/// A shape over [-half, half] around a place. Its ends and its middle are samples.
template <class Shape>
Signal around(double place, double half, const DefectGrid& grid, const Shape& shape) {
  // The mean over the patch spreads the shape beyond its ends.
  const int steps = whole_steps(half, grid.step);
  const double step = half / steps;
  if (!(grid.patch / step < kMostDefectSteps))
    refuse("E-IRREGULARITY-02",
           "a defect is too short for its contact patch, which covers over 1e7 of its steps; "
           "expected a longer defect or a shorter patch");
  const int beyond = static_cast<int>(std::ceil(grid.patch / step)) + 1;
  std::vector<double> samples;
  for (int k = -steps - beyond; k <= steps + beyond; ++k)
    samples.push_back(std::abs(k) >= steps ? 0. : shape(k * step));
  return averaged(fit_signal(samples, place - (steps + beyond) * step, step, false), grid.patch);
}

/// A shape over the circumference, of the distance from the middle of the turn.
template <class Shape>
Signal on_wheel(double radius, const DefectGrid& grid, const Shape& shape) {
  const int half = whole_steps(.5 * kTwoPi * radius, grid.step);
  const double step = .5 * kTwoPi * radius / half;
  std::vector<double> samples;
  for (int k = -half; k < half; ++k) samples.push_back(shape(k * step));
  return averaged(fit_signal(samples, 0., step, true), grid.patch);
}

void want_flat(double radius, double length) {
  if (!(length > 0.) || !(length < radius))
    refuse("E-IRREGULARITY-03",
           "the length of a flat is out of range; expected above 0 and below the wheel's radius");
}

}  // namespace

DefectGrid defect_grid(double patch, double shape) {
  return {patch > 0. ? std::min(patch / 4., shape / 50.) : shape / 500., patch};
}

Signal dipped_joint(double place, double depth, double ramp, const DefectGrid& grid) {
  return around(place, ramp, grid, [=](double x) { return -depth * (1. - std::fabs(x) / ramp); });
}

Signal corrugation(double from, double to, double wavelength, double amplitude,
                   const DefectGrid& grid) {
  const double half = .5 * (to - from);
  if (!(wavelength > 0.) || !(half >= wavelength))
    refuse("E-IRREGULARITY-04",
           "the corrugation is shorter than two wavelengths; expected two or more");
  return around(.5 * (from + to), half, grid, [=](double x) {
    const double to_end = (half - std::fabs(x)) / wavelength;
    const double fade = to_end < 1. ? .5 * (1. - cosine_sine(.5 * to_end).cosine) : 1.;
    return amplitude * fade * cosine_sine((x + half) / wavelength).sine;
  });
}

Signal fresh_flat(double radius, double length, const DefectGrid& grid) {
  want_flat(radius, length);
  return on_wheel(radius, grid, [=](double x) {
    const double from_corner = .5 * length - std::fabs(x);
    return from_corner > 0. ? -from_corner * from_corner / (2. * radius) : 0.;
  });
}

Signal rounded_flat(double radius, double length, double depth, const DefectGrid& grid) {
  want_flat(radius, length);
  return on_wheel(radius, grid, [=](double x) {
    return std::fabs(x) < .5 * length ? -.5 * depth * (1. + cosine_sine(x / length).cosine) : 0.;
  });
}

Signal out_of_round(double radius, int order, double amplitude, const DefectGrid& grid) {
  if (order < 1)
    refuse("E-IRREGULARITY-05", "the order of an out-of-round wheel is " + std::to_string(order) +
                                    "; expected 1 or more");
  return on_wheel(radius, grid, [=](double x) {
    return amplitude * cosine_sine(order * x / (kTwoPi * radius)).cosine;
  });
}

}  // namespace railstep
