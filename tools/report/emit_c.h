#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace railstep {

/// A block as C99 and C++17 source: one `static const` structure NAME with the bytes of the block,
/// reals as hexadecimal floats, and its size NAME_bytes; for machines without a file system.
/// @param block  that load_model() takes
/// @param name   an identifier
std::string emit_c(const std::vector<std::byte>& block, const std::string& name);

/// An identifier of a file's name without its extension: `track.1` is track_1_model.
std::string identifier(const std::string& stem);

}  // namespace railstep
