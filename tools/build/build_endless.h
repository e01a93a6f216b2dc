#pragma once
#include <string>
#include <vector>

#include "scene/scene.h"

namespace railstep {

/// Bays of a scene's ring or window that lie behind x = 0, so that the traffic stands in its
/// middle.
int bays_behind(const Scene& scene);

/// "track.bays=N" for a window in full order that has room for a scene's traffic, where the scene's
/// ring is shorter; else empty. (A ring needs one decay length, a window one on either side.)
std::vector<std::string> longer_window(const Scene& scene);

}  // namespace railstep
