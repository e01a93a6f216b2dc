#pragma once
#include <array>
#include <vector>

#include "offline/pack/pack.h"
#include "scene/scene.h"

namespace railstep {

/// Irregularities and defects of a scene's rails. Reads the scene's record where it names one, and
/// generates where it names a spectrum. Throws InputError.
std::vector<RailIrregularity> irregularities_of(const Scene& scene);

/// What the left and the right wheel lack of being round, over the distance rolled.
std::array<Signal, 2> treads_of(const WheelsetScene& wheelset);

/// The same of each wheel of a vehicle; none where all are round.
std::vector<Signal> treads_of(const VehicleScene& vehicle);

}  // namespace railstep
