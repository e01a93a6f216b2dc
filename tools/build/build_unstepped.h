#pragma once
#include "scene/scene.h"

namespace railstep {

/// Refuses what a scene may say but a run does not step, so that nothing is left out in silence.
/// Throws InputError.
void refuse_unstepped(const Scene& scene);

}  // namespace railstep
