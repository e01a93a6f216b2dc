#pragma once
#include "scene/scene.h"

namespace railstep {

/// Refuses scenes that can be read but that a run does not step, so that nothing is left out in
/// silence. Throws InputError.
void refuse_unstepped(const Scene& scene);

}  // namespace railstep
