#pragma once
#include <filesystem>
#include <string>

#include "scene/scene_system.h"

namespace railstep::fuzz {

/// Whether a scene is so small that it can be built and stepped within a fuzzer's patience.
bool is_small(const AnyScene& scene);

/// Reads, builds and steps a scene, where it is accepted, as stepping.h has it; the model that
/// comes of it is that of the scene read again from what `rewritten` makes of the file.
void run_scene(const std::filesystem::path& file);

}  // namespace railstep::fuzz
