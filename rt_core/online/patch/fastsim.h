#pragma once
#include "online/patch/creep.h"

namespace railstep {

/// Kalker's simplified theory on strips x strips cells: J. J. Kalker, A fast algorithm for the
/// simplified theory of rolling contact, Vehicle System Dynamics 11, 1982. It has three
/// flexibilities and a parabolic limit of the stress. Stresses are taken at the middles of cells,
/// the slip half-way between them; the first step from the leading edge is half a cell. Strips go
/// side by side over the machine's lanes.
/// @param strips  1 to kMostStrips
CreepForce fastsim(const CreepPatch& patch, const Creepages<double>& creepages, int strips,
                   CreepWanted wanted) noexcept;

}  // namespace railstep
