#pragma once
#include "run/simulation.h"

namespace railstep {

/// The largest factor by which a frame multiplies a small change of the state: the spectral radius
/// of the frame's map about the state as it stands, by central differences of fourth order. Over 1
/// the coupled step grows. Moving traffic is taken where the state has it; changes are 5e-3 of the
/// least depth that is pressed by Hertz's law, else 1e-8 m. Padding, and numbers that a
/// condensed line only keeps of its loads, are not seen. Dense: for models of track, loads and
/// vehicles, of some 200 unknowns. The simulation's state is left as it was. NaN where the
/// eigenvalues are not found.
double growth_of(Simulation& run);

}  // namespace railstep
