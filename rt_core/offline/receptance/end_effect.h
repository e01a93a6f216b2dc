#pragma once
#include <complex>
#include <vector>

#include "offline/receptance/receptance.h"

namespace railstep {

/// The track with ends of the other kind: pinned where they are free or clamped, free where they
/// are pinned. A bending wave comes back from a pin as -1 of itself, from a free or a clamped end
/// as -i, so that whatever waves bring back from the ends changes. Non-reflecting ends stay.
Track with_other_ends(const Track& track);

/// A track and what is asked of the same places on it.
struct LongerTrack {
  Track track;
  Transfer transfer;
};

/// The track with zones four times as long before its non-reflecting ends, and as many bays more;
/// seats beyond the old ends are as the last ones. Where the track stands under its weight is left
/// out.
LongerTrack with_longer_zones(const Track& track, const Transfer& transfer);

/// What an answer owes to the ends of the track: |H - H'| / |H|, H' with the other ends and with
/// longer zones, at every frequency. A track without end has 0; of the error against it this is the
/// size, half to six times.
/// @param hz  above 0  @param answer  of the first read on the track as it stands, m/N
std::vector<double> end_effect(const Track& track, const Transfer& transfer,
                               const std::vector<double>& hz,
                               const std::vector<std::complex<double>>& answer);

}  // namespace railstep
