#pragma once
#include "offline/track/track.h"

namespace railstep {

/// The smallest compression of the rails, N, at which the track's stiffness K0 - P K_g is no longer
/// positive definite: it buckles. K_g is that of a uniform stress P/A in Green-Lagrange strain.
/// Whatever axial force the track has is not looked at. Infinite where none up to E A makes it
/// buckle; 0 or a rounding of it where a free rigid mode turns the rail.
///
/// By bisection on the signs of the pivots of K0 - P K_g, those within 1e-12 of their diagonal
/// taken as rounding: on a rail of kilometres between its ends the result is too high, by 1.5e-5 of
/// it over 1.5 km and by 4 % over 10 km.
double critical_compression(const Track& track);

/// Throws std::invalid_argument, naming both forces, where the track's rails carry as much
/// compression as makes it buckle, or more.
void refuse_buckled(const Track& track);

}  // namespace railstep
