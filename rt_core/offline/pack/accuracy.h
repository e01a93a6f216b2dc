#pragma once
#include <array>
#include <vector>

#include "offline/pack/pack.h"

namespace railstep {

/// Largest error of the static deflection under a unit force of every kind of port, over
/// kStaticPlaces places at equal steps along the track, each half-way between two of the tables'
/// own, against a track of elements so fine that these are nodes; over the largest deflection. 0
/// without ports. Of a track with one-sided supports the larger of two: of the track at rest, in
/// which those without a gap are springs and those with one open, and where under each force alone
/// those press that it presses, gaps counting as nothing.
double static_error(const Track& track, const PackedModel& packed);

/// The same of the receptance magnitude and phase together, |H - H_ref| over the largest |H_ref|,
/// at the middle of the track's middle bay and over its seat, over a band in Hz at
/// kReceptancePoints logarithmic steps, against a track of 2 times finer elements; both at rest.
double receptance_error(const Track& track, const PackedModel& packed,
                        const std::array<double, 2>& band);

/// The same at each of these frequencies, over the largest |H_ref| of them all. [hz]
std::vector<double> receptance_errors(const Track& track, const PackedModel& packed,
                                      const std::vector<double>& hz);

/// kReceptancePoints frequencies at logarithmic steps over a band, Hz, its ends included.
std::vector<double> receptance_frequencies(const std::array<double, 2>& band);

inline constexpr int kStaticPlaces = 128;  // fewer on a track of fewer intervals
inline constexpr int kReceptancePoints = 40;

}  // namespace railstep
