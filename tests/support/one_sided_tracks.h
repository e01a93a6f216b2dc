#pragma once
#include "support/condensed_tracks.h"
#include "support/fine_track.h"
#include "support/reference_tracks.h"

namespace railstep {

/// Opens a gap between the ground and the sleeper of a seat, or its pad if it has no sleeper.
inline Track with_gap(Track track, int border, double gap, bool left = true, bool right = true) {
  Seat seat = track.seat(border);
  for (const std::size_t side : {0u, 1u}) {
    if (!(side == 0 ? left : right)) continue;
    (seat.sleeper ? seat.ballast[side].gap : seat.pad[side].gap) = gap;
  }
  track.changed_seats[border] = seat;
  return track;
}

inline Traffic passing(double from, double speed, double force, double to) {
  return {.loads = {{.start = from, .speed = speed, .stop = to, .force = force}}};
}

}  // namespace railstep
