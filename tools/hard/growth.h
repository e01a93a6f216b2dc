#pragma once
#include "simulation.h"

namespace railstep {

/// The largest factor by which a frame multiplies a small change of the state: the spectral radius
/// of the frame's map about the state as it stands, by central differences. Over 1 the coupled step
/// grows. Moving traffic is taken where the state has it. Dense: for models of some 200 unknowns.
/// The simulation's state is left as it was. NaN where the eigenvalues are not found.
double growth_of(Simulation& run);

}  // namespace railstep
