#pragma once
#include <filesystem>
#include <string_view>

namespace railstep {

/// Writes a whole file: first beside its place, then renamed into it, so that a reader never sees
/// half a file and a failed write leaves the old one. Throws std::runtime_error naming the file
/// and the reason (no such folder, disk full); nothing is left beside it then.
void write_file(const std::filesystem::path& file, std::string_view content);

}  // namespace railstep
