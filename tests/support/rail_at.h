#pragma once
#include "offline/track/track.h"

namespace railstep {

/// The axis of a rail at x, m, and its vertical direction.
inline RailPoint at(double x, int rail = 0) { return {rail, x, 0., 0., 2}; }

}  // namespace railstep
