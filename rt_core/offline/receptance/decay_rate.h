#pragma once
#include <array>
#include <vector>

#include "offline/receptance/receptance.h"

namespace railstep {

/// Distances of EN 15461:2008+A1:2010 (6.7, Figure 2) in sleeper bays: where the rail is struck,
/// from the accelerometer in the middle of a bay on.
inline constexpr std::array<double, 29> kDecayBays = {
    0., .25, .5, .75, 1.,  1.25, 1.5, 1.75, 2.,  2.25, 2.5, 3.,  3.5, 4., 5.,
    6., 7.,  8., 10., 12., 16.,  20., 24.,  30., 36.,  42., 48., 54., 66.};

/// 10 lg e, to the standard's four digits.
inline constexpr double kDecayFactor = 4.343;

/// Its Formula 1: 4.343 / sum |A(x_n)|^2 / |A(x_0)|^2 dx_n, dB/m, the rate of a response that falls
/// as e^(-beta x), 8.686 beta. dx_n reaches half-way to both neighbours (A.2), dx_0 to one, the
/// last from the position before it.
/// @param distance  m from 0 on, rising; two or more  @param energy  |A|^2 there, in any unit
double decay_rate(const std::vector<double>& distance, const std::vector<double>& energy);

/// A one-third octave band, its limits at 10^(+-1/20) of 1000 Hz 10^(n/10).
struct ThirdOctave {
  int nominal_hz;   // its name: 100, 125, 160, ...
  double from, to;  // Hz
};

/// The bands of the standard, 100 to 5000 Hz, that lie within two frequencies.
std::vector<ThirdOctave> third_octaves(double from_hz, double to_hz);

/// Decay rate along a rail in one band.
struct DecayRate {
  ThirdOctave band;
  double rate;     // dB/m
  double drop_db;  // of the response at the last position under that at the first
  /// Clause 7 and 6.7: the rate is at least twice Formula 2's 4.343/x_max, and the response is 10
  /// dB down at the last position. Otherwise the track is too short, and the rate is an upper
  /// bound.
  bool suitable;
};

/// Positions on the rail from a point on towards the farther end, m from the point.
std::vector<double> decay_distances(const Track& track, double x);

/// @param along  the driving point first, then the other positions; vertical or lateral
std::vector<DecayRate> decay_rates(Receptance& along, const std::vector<double>& distance,
                                   const std::vector<ThirdOctave>& bands);

/// Frequencies at which a band's accelerance is taken, at equal steps within it.
inline constexpr int kLinesPerBand = 20;

}  // namespace railstep
