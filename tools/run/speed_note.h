#pragma once
#include <optional>

#include "scene/scene.h"
#include "text/message.h"

namespace railstep {

/// A note on traffic that runs at over 0.8 of the track's critical speed: deflections then depend
/// on the dampers, and on how far it has run. Nothing where no traffic does.
std::optional<Message> speed_note(const Scene& scene, const Track& track);

}  // namespace railstep
