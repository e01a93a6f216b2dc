#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace railstep::fuzz {

/// Blocks of small scenes of every kind (corpus/scene/), made at the first request.
const std::vector<std::byte>& base_block(std::size_t which);
/// The file of that block's scene.
std::string base_scene(std::size_t which);
std::size_t base_count();

}  // namespace railstep::fuzz
