#pragma once
#include <filesystem>
#include <string>

#include "scene/scene_system.h"

namespace railstep::fuzz {

/// Whether a scene is small enough to be built and stepped within a fuzzer's patience.
bool is_small(const AnyScene& scene);

/// Reads, builds and steps a scene as in stepping.h if it is accepted. The file that `rewritten`
/// makes of it must give the same model.
void run_scene(const std::filesystem::path& file);

}  // namespace railstep::fuzz
