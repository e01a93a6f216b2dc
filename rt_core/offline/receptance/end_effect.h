#pragma once
#include <complex>
#include <vector>

#include "offline/receptance/receptance.h"

namespace railstep {

/// The track with ends of the other kind: pinned where they are free or clamped, free where they
/// are pinned. A bending wave comes back from a pin as -1 of itself, from a free or a clamped end
/// as -i, so that every returning wave changes. Non-reflecting ends stay.
Track with_other_ends(const Track& track);

/// A track, and the transfer between the same places on it.
struct LongerTrack {
  Track track;
  Transfer transfer;
};

/// The track with zones four times as long before its non-reflecting ends, and as many bays more;
/// seats beyond the old ends are as the last ones. The track's state under its weight is left out.
LongerTrack with_longer_zones(const Track& track, const Transfer& transfer);

/// Effect of the ends on an answer: |H - H'| / |H| at every frequency, H' with the other ends and
/// with longer zones. It is 0 for a track without end, and half to six times the error against such
/// a track.
/// @param hz  above 0  @param answer  of the first read on the track as it stands, m/N
std::vector<double> end_effect(const Track& track, const Transfer& transfer,
                               const std::vector<double>& hz,
                               const std::vector<std::complex<double>>& answer);

}  // namespace railstep
