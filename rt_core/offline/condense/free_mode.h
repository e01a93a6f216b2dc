#pragma once
#include "offline/track/track.h"

namespace railstep {

/// Throws std::invalid_argument where the lowest mode of a line is rigid (below 1e-3 Hz): it has no
/// static answer. It names what nothing holds, where the line's stiffness shows it.
void refuse_free_mode(const Line& line, double lowest_hz);

}  // namespace railstep
