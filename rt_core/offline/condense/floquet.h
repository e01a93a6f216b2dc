#pragma once
#include <vector>

#include "offline/condense/mode_groups.h"

namespace railstep {

/// A line of a ring in Floquet modes: waves x e^(i k b) over the bays b, k = 2 pi m/N, m = 0 to
/// N/2.
///
/// A bay is its own mirror image about its seat, so that x can be rotated until mirroring and
/// conjugating leave it unchanged: then M(k), C(k), K(k) are real and symmetric, and every wave is
/// a standing one. k and -k together are a cosine and a sine, Re and Im of x e^(i k b), with the
/// same rates and coordinates; that fixes the phases of what would be a degenerate pair. Each k
/// keeps its lowest modes and the static shapes of its dampers, as modal_basis() does of a line.
struct RingModes {
  Basis basis;       // shapes over the ring; per k those of the cosine, then of the sine
  ModeGroups modes;  // a group to each of those
  /// The modes one bay further back, each in its own and its partner's coordinate: z' = cosine z +
  /// sine z[partner]. For k = 0 and k = pi the partner is the mode itself.
  std::vector<int> partner;  // [modes]
  Eigen::VectorXd cosine, sine;
};

/// @param limit  of the ring: of every k at most limit.most / track.bays modes, rounded
/// Throws Refused on a free rigid mode, and on a bay that is not its own mirror
/// image.
RingModes ring_modes(const Track& ring, const Line& line, const ModalLimit& limit);

}  // namespace railstep
