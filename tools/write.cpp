#include "write.h"

#include <fmt/core.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>

namespace railstep {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int reason) {
  throw std::runtime_error(
      fmt::format("{}: cannot be written: {}", file.string(), std::strerror(reason)));
}

}  // namespace

void write_file(const std::filesystem::path& file, std::string_view content) {
  // A device or a pipe (/dev/full, /dev/stdout) cannot be renamed over: write into it.
  std::error_code ignored;
  const bool in_place =
      std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored);
  std::filesystem::path beside = file;
  if (!in_place) beside += ".part";
  std::FILE* out = std::fopen(beside.c_str(), "wb");
  if (!out) fail(file, errno);
  errno = 0;
  const bool written = std::fwrite(content.data(), 1, content.size(), out) == content.size();
  int reason = written ? 0 : errno;
  if (std::fclose(out) != 0 && written) reason = errno;  // a full disk may only show here
  if (reason == 0 && !in_place && std::rename(beside.c_str(), file.c_str()) != 0) reason = errno;
  if (reason == 0 && written) return;
  if (!in_place) std::remove(beside.c_str());
  fail(file, reason);
}

}  // namespace railstep
