#pragma once
#include "scene.h"

namespace railstep {

/// Bays of a scene's ring or window that lie behind x = 0, so that the traffic stands in its
/// middle.
int bays_behind(const Scene& scene);

}  // namespace railstep
