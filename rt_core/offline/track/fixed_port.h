#pragma once
#include <vector>

#include "offline/track/functional.h"

namespace railstep {

/// A one-sided spring and damper of the track. With d = closing - gap it pushes its two sides apart
/// with max(0, stiffness d + damping d') while d > 0, and does not pull. A spring that is closed in
/// the track's state (gap < 0) is balanced there by its constant preload.
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

/// The one-sided springs of a track: for each rail, seat by seat, the pad (two halves with a
/// half_spread) and the ballast; then the stops; then the ends of rails at joints if rails move
/// along x. Springs without stiffness and damping are left out.
std::vector<FixedPort> fixed_ports(const Track& track);

/// Its closing over the unknowns of one line.
Eigen::SparseVector<double> closing_row(const Track& track, const Line& line,
                                        const FixedPort& port);

/// The preloads of all ports over the unknowns of one line, N.
Eigen::VectorXd preload(const Track& track, const Line& line);

/// The track about its unloaded state: one-sided springs without a gap, and ends of rails that heat
/// closes, count as bilateral springs. Springs with a gap, and stops, stay out of its lines.
Track linear_about_rest(Track track);

/// Whether the port counts as bilateral there.
bool is_closed_at_rest(const FixedPort& port);

/// The track without its one-sided springs.
Track all_open(Track track);

}  // namespace railstep
