#pragma once
#include <string>

#include "scene/scene_system.h"

namespace railstep {

/// Words of a model file about itself, a line each: program, scene with its SHA-256 (of the scene
/// file and of the overrides, a line each), units, axes, scheme and step. There is no date.
std::string about(const Scene& scene);
std::string about(const SystemScene& scene);

}  // namespace railstep
