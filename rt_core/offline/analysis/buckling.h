#pragma once
#include "offline/track/track.h"

namespace railstep {

/// Throws Refused, and names both forces, if the track's rails carry at least the compression P at
/// which it buckles. From that P on the stiffness K0 - P K_g has an eigenvalue of 0 or below; K_g
/// is that of a uniform stress P/A in Green-Lagrange strain.
///
/// By bisection on the signs of the pivots of K0 - P K_g, those within 1e-12 of their diagonal
/// taken as rounding: on a rail of kilometres between its ends the result is too high, by 1.5e-5 of
/// it over 1.5 km and by 4 % over 10 km.
void refuse_buckled(const Track& track);

}  // namespace railstep
