#pragma once
#include <array>
#include <vector>

#include "offline/pack/pack.h"
#include "scene/scene.h"

namespace railstep {

/// Irregularities and defects of a scene's rails. They are read from the scene's record, or
/// generated from its spectrum. Throws InputError.
std::vector<RailIrregularity> irregularities_of(const Scene& scene);

/// How much lower than a round wheel the left and the right wheel sit, over the distance rolled, m.
std::array<Signal, 2> treads_of(const WheelsetScene& wheelset);

/// The same for each wheel of a vehicle; empty where all wheels are round.
std::vector<Signal> treads_of(const VehicleScene& vehicle);

}  // namespace railstep
