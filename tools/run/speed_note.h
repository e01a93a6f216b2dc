#pragma once
#include <string>

#include "scene/scene.h"

namespace railstep {

/// What is to be said of traffic that runs at over 0.8 of the track's critical speed: what is under
/// it then hangs on the dampers, and on how far it has run. Empty where none does.
std::string speed_note(const Scene& scene, const Track& track);

}  // namespace railstep
