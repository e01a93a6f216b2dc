#pragma once
#include <vector>

#include "offline/track/functional.h"

namespace railstep {

/// A one-sided spring and damper of the track. With d = closing - gap it pushes what it stands
/// between apart with max(0, stiffness d + damping d') while d > 0, and does not pull. One that is
/// closed where the track stands (gap < 0) is balanced there by its preload, which stays.
struct FixedPort {
  Functional closing;     // displacement towards it, from the unloaded straight track
  double stiffness = 0.;  // N/m
  double damping = 0.;    // N s/m
  double gap = 0.;        // m
  double preload = 0.;    // N
  enum class Of { pad, ballast, stop, joint } of = Of::stop;
  int rail = 0;
  int seat = -1;   // of a pad or ballast
  int stop = -1;   // number of a stop
  int joint = -1;  // number of a joint
};

/// What of a track is one-sided: of each rail, seat by seat, pad (two halves where it has a
/// half_spread) and ballast, then the stops, then the ends of rails at joints where rails move
/// along x. Without stiffness and damping there is none.
std::vector<FixedPort> fixed_ports(const Track& track);

/// Its closing over the unknowns of one line.
Eigen::SparseVector<double> closing_row(const Track& track, const Line& line,
                                        const FixedPort& port);

/// The preloads of all ports over the unknowns of one line, N.
Eigen::VectorXd preload(const Track& track, const Line& line);

/// The track about its unloaded state: what has no gap and does not pull, and ends of rails that
/// heat closes, are taken for bilateral springs; what has a gap, and stops, stay out of its lines.
Track linear_about_rest(Track track);

/// Whether the port is such a spring.
bool is_closed_at_rest(const FixedPort& port);

/// The track with everything one-sided away.
Track all_open(Track track);

}  // namespace railstep
