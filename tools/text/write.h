#pragma once
#include <cstdio>
#include <filesystem>
#include <string_view>

namespace railstep {

/// A file as it grows. It is written beside its place under a name of its own, and gets its own
/// name once it is whole. So a reader never sees half a file, a failed write leaves the old one,
/// and where two programs write one file, that of the last to end stays. A device or a pipe is
/// written in place. Throws Failed naming the file and the reason (no such folder, disk full), and
/// InputError where it would replace a file that was read (files.h).
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path file);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();  // an unfinished file leaves nothing behind

  void write(std::string_view bytes);
  /// Closes the file and puts it in its place.
  void finish();

 private:
  void drop() noexcept;
  [[noreturn]] void fail(int reason);

  std::filesystem::path file_, beside_;  // beside_ is empty where the file is written in place
  std::FILE* out_ = nullptr;
};

/// Writes a whole file. Throws as OutputFile.
void write_file(const std::filesystem::path& file, std::string_view content);

}  // namespace railstep
