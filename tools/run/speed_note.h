#pragma once
#include <optional>

#include "scene/scene.h"
#include "text/message.h"

namespace railstep {

/// What is to be said of traffic that runs at over 0.8 of the track's critical speed: what is under
/// it then hangs on the dampers, and on how far it has run. Nothing where none does.
std::optional<Message> speed_note(const Scene& scene, const Track& track);

}  // namespace railstep
