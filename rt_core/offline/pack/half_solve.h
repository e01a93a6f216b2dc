#pragma once
#include <vector>

#include "online/math/band.h"

namespace railstep {

/// A solve of S = L D L' that stops halfway, for a right-hand side of few entries. It is cut where
/// it has faded: the part left out is below kFaded of the whole in the norm of S. By Schwarz's
/// inequality the error of each displacement is then below kFaded of the largest displacement by
/// such a force.
struct HalfSolve {
  Panels panels;                             // outside them both are 0
  std::vector<double> forward, over_pivots;  // L^-1 b, D^-1 L^-1 b
};
inline constexpr double kFaded = 1e-12;

/// @param b  8 panels entries
HalfSolve solve_halfway(const Band& S, std::vector<double> b);

/// How many panels behind that of a unit force solve_halfway() reaches, at most over all unknowns.
std::int32_t reach_of(const Band& S);

}  // namespace railstep
