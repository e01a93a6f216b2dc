#pragma once
#include <array>
#include <optional>
#include <vector>

#include "offline/pack/pack.h"

namespace railstep {

/// Largest error of the static deflection under a unit force of every kind of port, at
/// kStaticPlaces places at equal steps along the track, each half-way between two of the tables'
/// own, at all of these in the first and the last element, and at the ends, against a track of
/// elements so fine that these are nodes; over the largest deflection. 0 without ports. Of a track
/// with one-sided supports the larger of two: of the track at rest, in which those without a gap
/// are springs and those with one open, and where under each force alone those are closed
/// that it closes, gaps counting as nothing.
double static_error(const Track& track, const PackedModel& packed);

struct ReceptanceError {
  std::optional<double> largest;      // none where nothing is asked, or the track is undamped
  double hz = 0.;                     // where
  std::optional<double> undamped_hz;  // where the track swings without damping
  int solves = 0;                     // frequencies at which it was solved for
  double unresolved = 0.;             // what may be larger still, over the largest
};

/// The same of the receptance, magnitude and phase together: the largest |H - H_ref| over a band in
/// Hz over the largest |H_ref| in it, at receptance_places(), against a track of elements finer by
/// receptance_refinement(). Found by a search (largest_over()), not on a grid. Both are at rest.
ReceptanceError receptance_error(const Track& track, const PackedModel& packed,
                                 const std::array<double, 2>& band);

/// The middle of the track's middle bay, and over the seat where it begins, m.
std::vector<double> receptance_places(const Track& track);

/// 2, or what makes kReceptanceElements a bay.
int receptance_refinement(const Track& track);

/// The same at each of these frequencies, over the largest |H_ref| of them all. [hz]
std::vector<double> receptance_errors(const Track& track, const PackedModel& packed,
                                      const std::vector<double>& hz);

/// kReceptancePoints frequencies at logarithmic steps over a band, Hz, its ends included.
std::vector<double> receptance_frequencies(const std::array<double, 2>& band);

inline constexpr int kStaticPlaces = 128;  // fewer on a track of fewer intervals
inline constexpr int kReceptancePoints = 40;
inline constexpr int kReceptanceElements = 4;

}  // namespace railstep
