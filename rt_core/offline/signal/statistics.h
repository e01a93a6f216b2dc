#pragma once
#include <vector>

namespace railstep {

/// Means over the windows [d, d + length] of a signal that is straight between its samples, d the
/// first distance, then a `step` further each time, as long as the window ends within the signal.
/// @param distance  m, rising
std::vector<double> sliding_mean(const std::vector<double>& distance,
                                 const std::vector<double>& values, double length, double step);
/// Roots of the mean squares over the same windows.
std::vector<double> sliding_rms(const std::vector<double>& distance,
                                const std::vector<double>& values, double length, double step);

/// Mean and root mean square of at least one value.
double mean_of(const std::vector<double>& values);
double rms_of(const std::vector<double>& values);

/// The value that a part of the values, 0 to 1, does not exceed; straight between two of them. NaN
/// of none.
double percentile(std::vector<double> values, double part);

/// Root mean squares of whole blocks, one after the other; the rest is left out.
/// @param dt  between two values, s
std::vector<double> block_rms(const std::vector<double>& values, double dt, double seconds);

/// Frequency of the largest line of a signal less its mean, Hz, on a grid of 0.05 Hz up to `to_hz`
/// or half the sampling rate. A line is the power of blocks of 20 s under Hann's window that
/// overlap by half (Welch 1967). NaN of a constant signal and of fewer than 3 values.
/// @param dt  between two values, s
double dominant_frequency(const std::vector<double>& values, double dt, double from_hz,
                          double to_hz);

}  // namespace railstep
