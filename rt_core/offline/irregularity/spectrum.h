#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace railstep {

/// Measures of a track's geometry: mean height of both rails, mean of their lateral positions,
/// height of the left rail over the right one, and increase of their distance.
enum class Geometry { vertical, alignment, cross_level, gauge };
inline constexpr int kGeometries = 4;
inline constexpr std::string_view kGeometryNames[kGeometries] = {"vertical", "alignment",
                                                                 "cross_level", "gauge"};

/// One-sided power spectral density over wave numbers W in rad/m, m2/(rad/m):
///   S(W) = factor W^(2 power) / product over its corners c of (W^2 + c^2),
/// so that the variance of a band is its integral over the band.
struct Spectrum {
  double factor = 0.;
  int power = 0;
  std::vector<double> corners = {};  // rad/m
  double at(double wave_number) const;
};

/// The four spectra of a named quality of track.
///
/// `ore_low`, `ore_high`: ORE B176 RP 1 (1989), low and high level, also known as the German
/// spectra of low and high disturbance, `german_low` and `german_high`, which add the gauge.
/// `fra_1` to `fra_6`: the classes of the US Federal Railroad Administration after Hamid and others
/// (1983); gauge as cross level. A geometry that a source does not give has factor 0.
struct TrackSpectra {
  std::string name;
  std::array<Spectrum, kGeometries> of;
};
const std::vector<TrackSpectra>& track_spectra();

/// @returns null if the name is unknown
const TrackSpectra* find_spectra(std::string_view name);

}  // namespace railstep
