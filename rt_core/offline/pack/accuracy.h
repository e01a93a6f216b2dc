#pragma once
#include <array>
#include <optional>
#include <vector>

#include "offline/pack/pack.h"

namespace railstep {

/// Largest error of the static deflection under a unit force at each load point, over the largest
/// deflection; 0 without load points. The reference is a track of elements so fine that all places
/// are nodes. The places are kStaticPlaces at equal steps along the track, each half-way between
/// two places of the tables; all of those half-way places in the first and the last element; and
/// the ends. With one-sided supports it is the larger of two errors: of the track at rest, where
/// supports without a gap are springs and supports with a gap are open; and of the track on which
/// each force alone closes its own supports, without their gaps.
double static_error(const Track& track, const PackedModel& packed);

struct ReceptanceError {
  std::optional<double> largest;      // empty without load points, or if the track is undamped
  double hz = 0.;                     // where
  std::optional<double> undamped_hz;  // at which the track vibrates without damping
  int solves = 0;                     // number of frequencies that were solved
  double unresolved = 0.;             // bound of what the search left, over the largest
};

/// The same for the receptance, magnitude and phase together: the largest |H - H_ref| in a band in
/// Hz over the largest |H_ref| in it, at receptance_places(). The reference is a track with
/// receptance_refinement() times the elements. A search finds it (largest_over()), not a grid. Both
/// tracks are at rest.
ReceptanceError receptance_error(const Track& track, const PackedModel& packed,
                                 const std::array<double, 2>& band);

/// The middle of the track's middle bay, and the seat where this bay begins, m.
std::vector<double> receptance_places(const Track& track);

/// 2, or the factor that gives kReceptanceElements elements a bay.
int receptance_refinement(const Track& track);

/// |H - H_ref| at each of these frequencies, over the largest |H_ref| of them all. [hz]
std::vector<double> receptance_errors(const Track& track, const PackedModel& packed,
                                      const std::vector<double>& hz);

/// kReceptancePoints frequencies at logarithmic steps over a band, Hz, its ends included.
std::vector<double> receptance_frequencies(const std::array<double, 2>& band);

inline constexpr int kStaticPlaces = 128;  // fewer on a track of fewer intervals
inline constexpr int kReceptancePoints = 40;
inline constexpr int kReceptanceElements = 4;

}  // namespace railstep
