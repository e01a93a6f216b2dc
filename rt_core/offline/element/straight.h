#pragma once
#include "offline/element/energy.h"
#include "online/beam/straight.h"

namespace railstep {

/// beam_element() of straight_nodes(length), for the fast kernel.
/// @param length  m, > 0
/// @throws std::invalid_argument on a rule without two points for all strains and on a section that
///         is not symmetric in y
StraightBeam straight_beam(const BeamLaw& law, double length);

}  // namespace railstep
