#pragma once
#include <complex>
#include <vector>

namespace railstep {

/// A rational function of s, rad/s: coefficients of s^0, s^1, ... The numerator's order is at most
/// the denominator's, whose last coefficient is not 0.
struct FilterSection {
  std::vector<double> numerator, denominator;
};
/// Stable sections in series.
using AnalogueFilter = std::vector<FilterSection>;

/// Butterworth's filters of fourth order: -3 dB at a frequency, Hz.
AnalogueFilter low_pass(double hz);
AnalogueFilter high_pass(double hz);
AnalogueFilter band_pass(double from_hz, double to_hz);

/// W_d and W_b of EN 12299:2009, which weight accelerations across and upwards.
AnalogueFilter comfort_lateral();
AnalogueFilter comfort_vertical();

/// Sperling's weighting of comfort, B(f), across and upwards, as in Forstberg, Ride comfort and
/// motion sickness in tilting trains, 2000. Only its size is known: phases are of a function of
/// this size.
AnalogueFilter ride_index_lateral();
AnalogueFilter ride_index_vertical();

std::complex<double> response(const AnalogueFilter& filter, double hz);

/// A filtered signal. Each section answers the straight lines between its samples without error; it
/// begins as if the first value had lasted for ever.
/// @param dt  between two values, s
std::vector<double> filtered(const AnalogueFilter& filter, std::vector<double> values, double dt);

}  // namespace railstep
