#pragma once
#include <array>

#include "offline/element/matrices.h"
#include "online/beam/straight.h"

namespace railstep {

/// beam_element() of straight_nodes(length), for the fast kernel.
/// @param length  m, > 0
/// @throws Refused on a rule without two points for all strains and on a section that
///         is not symmetric in y
StraightBeam straight_beam(const BeamLaw& law, double length);

/// Chain::mass of a section: its density times the integrals of 1, y2, z2, z about the law's
/// reference line; kg/m, kg m, kg m, kg. The rotary inertia is the section's own, as in
/// element_matrices().
std::array<double, 4> chain_mass(const BeamSection& section, const BeamLaw& law);

}  // namespace railstep
