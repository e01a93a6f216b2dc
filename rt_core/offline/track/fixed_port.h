#pragma once
#include <vector>

#include "offline/track/functional.h"

namespace railstep {

/// A one-sided spring and damper of the track. With d = closing - gap it presses what it stands
/// between apart with max(0, stiffness d + damping d') while d > 0, and does not pull.
struct FixedPort {
  Functional closing;     // displacement towards it, from the unloaded straight track
  double stiffness = 0.;  // N/m
  double damping = 0.;    // N s/m
  double gap = 0.;        // m
  enum class Of { pad, ballast, stop } of = Of::stop;
  int rail = 0;
  int seat = -1;  // of a pad or ballast
  int stop = -1;  // number of a stop
};

/// What of a track is one-sided: of each rail, seat by seat, pad (two halves where it has a
/// half_spread) and ballast, then the stops. Without stiffness and damping there is none.
std::vector<FixedPort> fixed_ports(const Track& track);

/// Its closing over the unknowns of one line.
Eigen::SparseVector<double> closing_row(const Track& track, const Line& line,
                                        const FixedPort& port);

/// The track about its unloaded state: what has no gap and does not pull is taken for a spring that
/// does; what has a gap, and stops, stay out of its lines.
Track linear_about_rest(Track track);

/// The track with everything one-sided away.
Track all_open(Track track);

}  // namespace railstep
