#pragma once
#include <string>

#include "scene/scene_system.h"

namespace railstep {

/// What a model file says of itself in words, a line each: program, scene with its SHA-256 (of the
/// scene file and, a line each, what was set over it), units, axes, scheme and step. No date.
std::string about(const Scene& scene);
std::string about(const SystemScene& scene);

}  // namespace railstep
