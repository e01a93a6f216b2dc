#include "offline/irregularity/spectrum.h"

namespace railstep {

namespace {

constexpr double kCorner = .8246, kLong = .0206, kCross = .438;  // rad/m, ORE B176

/// The roll of the rails is that of heights over b = 0.75 m (left and right each by half of the
/// difference): what the source gives over b^2 times (2 b)^2.
TrackSpectra ore(std::string name, double vertical, double lateral, double gauge) {
  const double c2 = kCorner * kCorner;
  return {
      std::move(name),
      {Spectrum{vertical * c2, 0, {kLong, kCorner}}, Spectrum{lateral * c2, 0, {kLong, kCorner}},
       Spectrum{4. * vertical * c2, 1, {kLong, kCorner, kCross}},
       Spectrum{gauge * c2, gauge > 0. ? 1 : 0, {kLong, kCorner, kCross}}}};
}

/// Coefficients in cm2 rad/m; a quarter of the printed ones for heights and alignment.
TrackSpectra fra(std::string name, double vertical, double lateral, double cross_corner) {
  constexpr double corner = .8245, per_cm2 = 1e-4;
  const double c2 = corner * corner * per_cm2;
  const Spectrum cross = {vertical * c2, 0, {corner, cross_corner}};
  return {std::move(name),
          {Spectrum{.25 * vertical * c2, 0, {0., corner}},
           Spectrum{.25 * lateral * c2, 0, {0., corner}}, cross, cross}};
}

}  // namespace

double Spectrum::at(double wave_number) const {
  const double w2 = wave_number * wave_number;
  double value = factor;
  for (int i = 0; i < power; ++i) value *= w2;
  for (const double corner : corners) value /= w2 + corner * corner;
  return value;
}

const std::vector<TrackSpectra>& track_spectra() {
  static const std::vector<TrackSpectra> all = {
      ore("ore_low", 4.032e-7, 2.119e-7, 0.),
      ore("ore_high", 1.08e-6, 6.125e-7, 0.),
      ore("german_low", 4.032e-7, 2.119e-7, .532e-7),
      ore("german_high", 1.08e-6, 6.125e-7, 1.032e-7),
      fra("fra_1", 1.2107, 3.3634, .6046),
      fra("fra_2", 1.0181, 1.2107, .9308),
      fra("fra_3", .6816, .4128, .8520),
      fra("fra_4", .5376, .3027, 1.1312),
      fra("fra_5", .2095, .0762, .8209),
      fra("fra_6", .0339, .0339, .4380),
  };
  return all;
}

const TrackSpectra* find_spectra(std::string_view name) {
  for (const TrackSpectra& spectra : track_spectra())
    if (spectra.name == name) return &spectra;
  return nullptr;
}

}  // namespace railstep
