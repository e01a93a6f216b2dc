#pragma once
#include "online/patch/creep_law.h"
#include "online/patch/creep_laws.h"

namespace railstep {

/// A creep force on the wheel and its derivatives.
struct CreepForce {
  double x, y;         // N
  double slope[2][3];  // of x and y over the creepages along, across and of spin, N, N, N m
};

/// The force of a patch under creepages, and its derivatives at a frozen patch; 0 where they are
/// not wanted.
/// @param strips  of FASTSIM, 1 to kMostStrips; the work grows with their square
CreepForce creep_force(CreepLaw law, int strips, const CreepPatch& patch,
                       const Creepages<double>& creepages,
                       CreepWanted wanted = CreepWanted::slopes) noexcept;

/// The patch of normalised creepages: half lengths whose product is 1, a shear modulus and a limit
/// of 1.
CreepPatch normalised_patch(double ratio, const Kalker& kalker) noexcept;
/// Creepages at that patch from normalised ones: x = 4 G ab xi / (mu N), e = 4 G ab eta / (mu N),
/// p = 2 G (ab)^1.5 phi / (mu N).
Creepages<double> normalised_creepages(double x, double e, double p) noexcept;

}  // namespace railstep
